/**
 * @file
 * rapkm_2rrr_rr: Planar 2RRR/RR parallel manipulator with two degrees of freedom and three drives (double
 * precision)
 * Source: A. Müller, Motion equations in redundant coordinates with application to inverse dynamics of
 * constrained mechanical systems, Sec. 5.4
 *
 * Coordinates q (rates qd and accelerations qdd in the same order):
 *   q[0] a_1 [rad] base angle of arm 1
 *   q[1] a_2 [rad] base angle of arm 2
 *   q[2] a_3 [rad] base angle of arm 3
 *   q[3] b_1 [rad] elbow angle of arm 1 relative to its first link
 *   q[4] b_2 [rad] elbow angle of arm 2 relative to its first link
 *   q[5] b_3 [rad] elbow angle of arm 3 relative to its first link
 * Inputs u:
 *   u[0] drive_1 [N*m] torque of the drive at base joint 1
 *   u[1] drive_2 [N*m] torque of the drive at base joint 2
 *   u[2] drive_3 [N*m] torque of the drive at base joint 3
 * Measured coordinates q_m (rates qd_m and accelerations qdd_m in the same order):
 *   a_1, a_2, a_3
 * Coordinates of the task x_t (rates xd_t and accelerations xdd_t in the same order):
 *   x, y
 *
 * Operations                          + -      *      /   sqrt sincos  other
 * mass_matrix                          15     18      0      0      3      0
 * coriolis_matrix                       4     18      0      0      3      0
 * coriolis_force                        4     24      0      0      3      0
 * potential_force                       0      0      0      0      0      0
 * applied_force                         0      0      0      0      0      0
 * constraint_residual                  23      8      0      0      6      0
 * constraint_jacobian                   9     12      0      0      6      0
 * constraint_jacobian_dot              12     18      0      0      6      0
 * constraint_pseudoinverse            142    218     14      4      6      0
 * nullspace_projector                 122    198      9      4      6      0
 * nullspace_projector_dot             383    549     14      4      6      0
 * weighted_pseudoinverse              280    488      1      0      6      0
 * weighted_nullspace_projector        224    350     22      4      6      0
 * control_matrix                        0      0      0      0      0      0
 * projected_control_matrix            101    177      1      0      6      0
 * projected_control_pseudoinverse      55    124      1      0      6      0
 * orthogonal_complement                17     38      3      0      9      0
 * projected_mass_matrix               282    419      9      4      6      0
 * projected_coriolis_matrix           714    987     14      4      6      0
 * projected_potential_force             0      0      0      0      0      0
 * projected_applied_force               0      0      0      0      0      0
 * minimal_mass_matrix                  63    114      1      0      6      0
 * minimal_coriolis_matrix             328    568      2      0      6      0
 * minimal_potential_force               0      0      0      0      0      0
 * minimal_applied_force                 0      0      0      0      0      0
 * minimal_control_matrix                8     15      1      0      6      0
 * admissible_velocity                 109    162      9      4      6      0
 * admissible_acceleration             192    271     13      4      6      0
 * projected_configuration             276    322     29     11     12      0
 * configuration_from_measured        1257   1528     84     23     36      0
 * velocity_from_measured               84    148      1      0      6      0
 * acceleration_from_measured          204    311     14      4      6      0
 * task_position                         5      4      0      0      2      0
 * task_velocity                         4      6      0      0      2      0
 * task_jacobian                         3      4      0      0      2      0
 * configuration_from_task             172    188     18     15      9      0
 * velocity_from_task                   18     42      6      0      6      0
 * acceleration_from_task               39     69     12      0      6      0
 * inverse_dynamics                     51     79      3      0      5      0
 * inverse_dynamics_residual             0      0      0      0      0      0
 * forward_dynamics                    195    317     18      0      6      0
 * multipliers                         153    266     18      0      6      0
 * energy                               20     31      0      0      3      0
 * singularity                          55     96     17      4      6      0
 * (changes of sign are not counted)
 *
 * Beyond these bounds of parameters results would lose digits; they have the status PARAMETER_RANGE there:
 *   constraint_residual l_1 <= 3
 *   constraint_pseudoinverse 0.015 <= l_1
 *   nullspace_projector 0.015 <= l_1, l_2 <= 3
 *   nullspace_projector_dot 0.015 <= l_1
 *   weighted_pseudoinverse 0.015 <= l_1, l_2 <= 0.94, 0.0051 <= m_1, m_2 <= 10
 *   weighted_pseudoinverse 1.1e-05 <= J_1, 1.1e-05 <= J_2 <= 0.1, 1.1e-05 <= J_motor, |m_payload| <= 1700
 *   weighted_nullspace_projector 0.015 <= l_1 <= 1.6, l_2 <= 3, m_2 <= 10, J_2 <= 1.7
 *   weighted_nullspace_projector |m_payload| <= 10
 *   projected_control_matrix 0.015 <= l_1, l_2 <= 3
 *   projected_control_pseudoinverse 0.015 <= l_1, l_2 <= 3
 *   orthogonal_complement l_2 <= 1600
 *   projected_mass_matrix 0.015 <= l_1, l_2 <= 3, |m_payload| <= 170
 *   projected_coriolis_matrix 0.015 <= l_1 <= 3, l_2 <= 3, |m_payload| <= 10
 *   minimal_mass_matrix 0.015 <= l_1, l_2 <= 3, |m_payload| <= 10
 *   minimal_coriolis_matrix 0.015 <= l_1 <= 3, l_2 <= 3, |m_payload| <= 170
 *   minimal_control_matrix l_2 <= 5300
 *   admissible_velocity 0.015 <= l_1, l_2 <= 3
 *   admissible_acceleration 0.015 <= l_1 <= 3, l_2 <= 3
 *   projected_configuration l_1 <= 3, l_2 <= 3, |y_1| <= 1
 *   configuration_from_measured l_1 <= 3, l_2 <= 3
 *   velocity_from_measured 0.015 <= l_1, l_2 <= 3
 *   acceleration_from_measured 0.015 <= l_1 <= 3, l_2 <= 3
 *   configuration_from_task l_1 <= 53, l_2 <= 3
 *   acceleration_from_task l_2 <= 3
 *   inverse_dynamics |m_payload| <= 310
 *   forward_dynamics m_1 <= 1700, J_1 <= 17, J_2 <= 170, J_motor <= 1.7
 *   forward_dynamics |m_payload| <= 10
 *   multipliers J_2 <= 0.1, |m_payload| <= 17
 *   energy |m_payload| <= 10
 *   singularity 0.015 <= l_1 <= 3, l_2 <= 3
 *
 * Every function returns a status. On a status other than 0 its outputs are untouched. Outputs may alias inputs.
 * Generated by symgen from the model file; do not edit. The code is whoever's it was generated for: the licence of
 * symgen does not extend to it.
 */
#ifndef RAPKM_2RRR_RR_H
#define RAPKM_2RRR_RR_H

#ifdef __cplusplus
extern "C" {
#endif

#ifndef RAPKM_2RRR_RR_MODEL_DEFINED
#define RAPKM_2RRR_RR_MODEL_DEFINED
/** The version of symgen that generated this. */
#define RAPKM_2RRR_RR_SYMGEN_VERSION "0.1.0"
/** SHA-256 of the model file. */
#define RAPKM_2RRR_RR_MODEL_HASH "b88bab567405d2a9e9eaeb0c926d9db98c7a21f6d9e4ed4bccba50ddd14e8352"

/** How many entries q, qd and qdd have. */
#define RAPKM_2RRR_RR_SIZE_Q 6
/** Which is which. */
enum {
    RAPKM_2RRR_RR_Q_A_1 = 0, /**< [rad] base angle of arm 1 */
    RAPKM_2RRR_RR_Q_A_2 = 1, /**< [rad] base angle of arm 2 */
    RAPKM_2RRR_RR_Q_A_3 = 2, /**< [rad] base angle of arm 3 */
    RAPKM_2RRR_RR_Q_B_1 = 3, /**< [rad] elbow angle of arm 1 relative to its first link */
    RAPKM_2RRR_RR_Q_B_2 = 4, /**< [rad] elbow angle of arm 2 relative to its first link */
    RAPKM_2RRR_RR_Q_B_3 = 5 /**< [rad] elbow angle of arm 3 relative to its first link */
};

/** How many entries inputs have. */
#define RAPKM_2RRR_RR_SIZE_U 3
/** Which is which. */
enum {
    RAPKM_2RRR_RR_U_DRIVE_1 = 0, /**< [N*m] torque of the drive at base joint 1 */
    RAPKM_2RRR_RR_U_DRIVE_2 = 1, /**< [N*m] torque of the drive at base joint 2 */
    RAPKM_2RRR_RR_U_DRIVE_3 = 2 /**< [N*m] torque of the drive at base joint 3 */
};

/** How many entries multipliers have. */
#define RAPKM_2RRR_RR_SIZE_LAMBDA 4
/** Which is which. */
enum {
    RAPKM_2RRR_RR_LAMBDA_LOOP_12_X = 0, /**< of the row loop_12_x */
    RAPKM_2RRR_RR_LAMBDA_LOOP_12_Y = 1, /**< of the row loop_12_y */
    RAPKM_2RRR_RR_LAMBDA_LOOP_13_X = 2, /**< of the row loop_13_x */
    RAPKM_2RRR_RR_LAMBDA_LOOP_13_Y = 3 /**< of the row loop_13_y */
};

/** How many entries q_m, qd_m and qdd_m have. */
#define RAPKM_2RRR_RR_SIZE_QM 3
/** Which is which. */
enum {
    RAPKM_2RRR_RR_QM_A_1 = 0, /**< [rad] base angle of arm 1 */
    RAPKM_2RRR_RR_QM_A_2 = 1, /**< [rad] base angle of arm 2 */
    RAPKM_2RRR_RR_QM_A_3 = 2 /**< [rad] base angle of arm 3 */
};

/** How many entries x_t, xd_t and xdd_t have. */
#define RAPKM_2RRR_RR_SIZE_XT 2
/** Which is which. */
enum {
    RAPKM_2RRR_RR_XT_X = 0, /**< x */
    RAPKM_2RRR_RR_XT_Y = 1 /**< y */
};

/** What functions return. */
typedef enum {
    RAPKM_2RRR_RR_OK = 0, /**< the result is valid */
    RAPKM_2RRR_RR_NOT_FINITE = 1, /**< an input that matters, or a result, is not finite */
    RAPKM_2RRR_RR_CONSTRAINT_RANK = 2, /**< the constraints lose rank at this configuration */
    RAPKM_2RRR_RR_ACTUATION_RANK = 3, /**< the inputs lose rank at this configuration */
    RAPKM_2RRR_RR_ANGLE_RANGE = 4, /**< an angle is beyond the range of the sine and cosine */
    RAPKM_2RRR_RR_MASS_RANK = 5, /**< the masses do not determine the acceleration although the constraints keep their rank */
    RAPKM_2RRR_RR_PARAMETER_RANGE = 6, /**< a parameter is so far from its value in the model file that the result would lose digits */
    RAPKM_2RRR_RR_MEASURED_RANK = 7, /**< what is measured does not determine the rest at this configuration */
    RAPKM_2RRR_RR_NOT_CLOSED = 8, /**< Newton's method has not closed the loops from this start */
    RAPKM_2RRR_RR_BRANCH = 9, /**< the start is so far away that the result may belong to another assembly mode */
    RAPKM_2RRR_RR_TASK_RANK = 10 /**< the task does not determine the rest at this configuration */
} rapkm_2rrr_rr_status;

/** What a status means, in English. */
static inline const char *rapkm_2rrr_rr_status_text(rapkm_2rrr_rr_status status) {
    const char *text = "no status of this model";
    switch (status) {
    case RAPKM_2RRR_RR_OK:
        text = "the result is valid";
        break;
    case RAPKM_2RRR_RR_NOT_FINITE:
        text = "an input that matters, or a result, is not finite";
        break;
    case RAPKM_2RRR_RR_CONSTRAINT_RANK:
        text = "the constraints lose rank at this configuration";
        break;
    case RAPKM_2RRR_RR_ACTUATION_RANK:
        text = "the inputs lose rank at this configuration";
        break;
    case RAPKM_2RRR_RR_ANGLE_RANGE:
        text = "an angle is beyond the range of the sine and cosine";
        break;
    case RAPKM_2RRR_RR_MASS_RANK:
        text = "the masses do not determine the acceleration although the constraints keep their rank";
        break;
    case RAPKM_2RRR_RR_PARAMETER_RANGE:
        text = "a parameter is so far from its value in the model file that the result would lose digits";
        break;
    case RAPKM_2RRR_RR_MEASURED_RANK:
        text = "what is measured does not determine the rest at this configuration";
        break;
    case RAPKM_2RRR_RR_NOT_CLOSED:
        text = "Newton's method has not closed the loops from this start";
        break;
    case RAPKM_2RRR_RR_BRANCH:
        text = "the start is so far away that the result may belong to another assembly mode";
        break;
    case RAPKM_2RRR_RR_TASK_RANK:
        text = "the task does not determine the rest at this configuration";
        break;
    default:
        break;
    }
    return text;
}
#endif

/** Parameters. */
typedef struct {
    double l_1; /**< [m] length of the first links; default 0.2 */
    double l_2; /**< [m] length of the second links; default 0.2 */
    double x_1; /**< [m] base joint 1 along the first axis; default 0.0 */
    double y_1; /**< [m] base joint 1 along the second axis; default 0.0 */
    double x_2; /**< [m] base joint 2 along the first axis; default 0.4 */
    double y_2; /**< [m] base joint 2 along the second axis; default 0.0 */
    double x_3; /**< [m] base joint 3 along the first axis; default 0.2 */
    double y_3; /**< [m] base joint 3 along the second axis; default 0.3464 */
    double m_1; /**< [kg] mass of each first link with its centre in the middle; default 0.2 */
    double m_2; /**< [kg] mass of each second link with its centre in the middle; default 0.15 */
    double J_1; /**< [kg*m**2] moment of inertia of each first link about its centre; default 0.0008 */
    double J_2; /**< [kg*m**2] moment of inertia of each second link about its centre; default 0.0006 */
    double J_motor; /**< [kg*m**2] moment of inertia of each drive; default 0.001 */
    double m_payload; /**< [kg] mass at the end-effector carried by arm 1; default 0.1 */
} rapkm_2rrr_rr_params;

/** The values of the model file. */
rapkm_2rrr_rr_params rapkm_2rrr_rr_default_params(void);

/** G: generalized mass matrix, (3); 6 x 6, row-major */
rapkm_2rrr_rr_status rapkm_2rrr_rr_mass_matrix(const double q[6], const rapkm_2rrr_rr_params *p, double G[36]);

/** C: Coriolis matrix of Christoffel symbols, along qd as given, (3); 6 x 6, row-major */
rapkm_2rrr_rr_status rapkm_2rrr_rr_coriolis_matrix(const double q[6], const double qd[6], const rapkm_2rrr_rr_params *p, double C[36]);

/** C q̇: Coriolis and centrifugal forces, (3); length 6 */
rapkm_2rrr_rr_status rapkm_2rrr_rr_coriolis_force(const double q[6], const double qd[6], const rapkm_2rrr_rr_params *p, double C_qd[6]);

/** Q: gradient of the potential energy, (3); length 6 */
rapkm_2rrr_rr_status rapkm_2rrr_rr_potential_force(const double q[6], const rapkm_2rrr_rr_params *p, double Q[6]);

/** Q_a: applied generalized forces, on the right-hand side; length 6 */
rapkm_2rrr_rr_status rapkm_2rrr_rr_applied_force(const double q[6], const double qd[6], const rapkm_2rrr_rr_params *p, double Q_a[6]);

/** g: geometric constraints, zero on the configuration space, (4); length 4 */
rapkm_2rrr_rr_status rapkm_2rrr_rr_constraint_residual(const double q[6], const rapkm_2rrr_rr_params *p, double g[4]);

/** B: coefficients of the velocity constraints, (1); 4 x 6, row-major */
rapkm_2rrr_rr_status rapkm_2rrr_rr_constraint_jacobian(const double q[6], const rapkm_2rrr_rr_params *p, double B[24]);

/** Ḃ: time derivative of the constraint Jacobian along qd; 4 x 6, row-major */
rapkm_2rrr_rr_status rapkm_2rrr_rr_constraint_jacobian_dot(const double q[6], const double qd[6], const rapkm_2rrr_rr_params *p, double B_dot[24]);

/** B⁺: Moore-Penrose inverse of the constraint Jacobian; 6 x 4, row-major */
rapkm_2rrr_rr_status rapkm_2rrr_rr_constraint_pseudoinverse(const double q[6], const rapkm_2rrr_rr_params *p, double B_pinv[24]);

/** N_B: orthogonal projector onto the admissible velocities, (21); 6 x 6, row-major */
rapkm_2rrr_rr_status rapkm_2rrr_rr_nullspace_projector(const double q[6], const rapkm_2rrr_rr_params *p, double N_B[36]);

/** Ṅ_B: time derivative of the projector along qd, Remark 9; 6 x 6, row-major */
rapkm_2rrr_rr_status rapkm_2rrr_rr_nullspace_projector_dot(const double q[6], const double qd[6], const rapkm_2rrr_rr_params *p, double N_B_dot[36]);

/** B_G⁺: pseudoinverse of B weighted by the mass matrix, (17); 6 x 4, row-major */
rapkm_2rrr_rr_status rapkm_2rrr_rr_weighted_pseudoinverse(const double q[6], const rapkm_2rrr_rr_params *p, double B_G_pinv[24]);

/** N_{B,G}: projector weighted by the mass matrix, (19); 6 x 6, row-major */
rapkm_2rrr_rr_status rapkm_2rrr_rr_weighted_nullspace_projector(const double q[6], const rapkm_2rrr_rr_params *p, double N_BG[36]);

/** M: generalized forces per unit of each input, (3); 6 x 3, row-major */
rapkm_2rrr_rr_status rapkm_2rrr_rr_control_matrix(const double q[6], const rapkm_2rrr_rr_params *p, double M[18]);

/** M̃: control matrix projected with N_B, (21); 6 x 3, row-major */
rapkm_2rrr_rr_status rapkm_2rrr_rr_projected_control_matrix(const double q[6], const rapkm_2rrr_rr_params *p, double M_tilde[18]);

/** M̃⁺: pseudoinverse of M̃, (27), (28); 3 x 6, row-major */
rapkm_2rrr_rr_status rapkm_2rrr_rr_projected_control_pseudoinverse(const double q[6], const rapkm_2rrr_rr_params *p, double M_tilde_pinv[18]);

/** F: velocities per independent velocity, (8); 6 x 2, row-major */
rapkm_2rrr_rr_status rapkm_2rrr_rr_orthogonal_complement(const double q[6], const rapkm_2rrr_rr_params *p, double F_B[12]);

/** G̃: projected mass matrix, (30); 6 x 6, row-major */
rapkm_2rrr_rr_status rapkm_2rrr_rr_projected_mass_matrix(const double q[6], const rapkm_2rrr_rr_params *p, double G_tilde[36]);

/** C̃: projected Coriolis matrix, along N_B qd, (30); 6 x 6, row-major */
rapkm_2rrr_rr_status rapkm_2rrr_rr_projected_coriolis_matrix(const double q[6], const double qd[6], const rapkm_2rrr_rr_params *p, double C_tilde[36]);

/** Q̃: projected potential forces, (30); length 6 */
rapkm_2rrr_rr_status rapkm_2rrr_rr_projected_potential_force(const double q[6], const rapkm_2rrr_rr_params *p, double Q_tilde[6]);

/** N_B Q_a: projected applied forces, at N_B qd; length 6 */
rapkm_2rrr_rr_status rapkm_2rrr_rr_projected_applied_force(const double q[6], const double qd[6], const rapkm_2rrr_rr_params *p, double Q_a_tilde[6]);

/** Ḡ: mass matrix in the independent velocities, (9); 2 x 2, row-major */
rapkm_2rrr_rr_status rapkm_2rrr_rr_minimal_mass_matrix(const double q[6], const rapkm_2rrr_rr_params *p, double G_bar[4]);

/** C̄: Coriolis matrix in the independent velocities, (9); 2 x 2, row-major */
rapkm_2rrr_rr_status rapkm_2rrr_rr_minimal_coriolis_matrix(const double q[6], const double qd[6], const rapkm_2rrr_rr_params *p, double C_bar[4]);

/** Q̄: potential forces on the independent velocities, (9); length 2 */
rapkm_2rrr_rr_status rapkm_2rrr_rr_minimal_potential_force(const double q[6], const rapkm_2rrr_rr_params *p, double Q_bar[2]);

/** FᵀQ_a: applied forces on the independent velocities; length 2 */
rapkm_2rrr_rr_status rapkm_2rrr_rr_minimal_applied_force(const double q[6], const double qd[6], const rapkm_2rrr_rr_params *p, double Q_a_bar[2]);

/** M̄: control matrix of the independent velocities, (9); 2 x 3, row-major */
rapkm_2rrr_rr_status rapkm_2rrr_rr_minimal_control_matrix(const double q[6], const rapkm_2rrr_rr_params *p, double M_bar[6]);

/** N_B q̇₀: the nearest velocity that satisfies the constraints, Remark 9; length 6 */
rapkm_2rrr_rr_status rapkm_2rrr_rr_admissible_velocity(const double q[6], const double qd[6], const rapkm_2rrr_rr_params *p, double qd_admissible[6]);

/** N_B q̈₀ + Ṅ_B q̇: acceleration made admissible, Remark 9; length 6 */
rapkm_2rrr_rr_status rapkm_2rrr_rr_admissible_acceleration(const double q[6], const double qd[6], const double qdd[6], const rapkm_2rrr_rr_params *p, double qdd_admissible[6]);

/** q − B⁺g: two Newton steps towards the configuration space; length 6 */
rapkm_2rrr_rr_status rapkm_2rrr_rr_projected_configuration(const double q[6], const rapkm_2rrr_rr_params *p, double q_projected[6]);

/** q(q_m): the configuration with the measured coordinates, or nearest to them, on the branch of q; length 6 */
rapkm_2rrr_rr_status rapkm_2rrr_rr_configuration_from_measured(const double q_m[3], const double q[6], const rapkm_2rrr_rr_params *p, double q_result[6]);

/** q̇(q̇_m): the admissible velocity with the measured rates, or nearest to them; length 6 */
rapkm_2rrr_rr_status rapkm_2rrr_rr_velocity_from_measured(const double q[6], const double qd_m[3], const rapkm_2rrr_rr_params *p, double qd_result[6]);

/** q̈(q̈_m): the admissible acceleration with the measured ones, or nearest to them, at the measured velocity;
    length 6 */
rapkm_2rrr_rr_status rapkm_2rrr_rr_acceleration_from_measured(const double q[6], const double qd_m[3], const double qdd_m[3], const rapkm_2rrr_rr_params *p, double qdd_result[6]);

/** x: coordinates of the task; length 2 */
rapkm_2rrr_rr_status rapkm_2rrr_rr_task_position(const double q[6], const rapkm_2rrr_rr_params *p, double x[2]);

/** ẋ: their rates; length 2 */
rapkm_2rrr_rr_status rapkm_2rrr_rr_task_velocity(const double q[6], const double qd[6], const rapkm_2rrr_rr_params *p, double xd[2]);

/** J_x: derivatives of the coordinates of the task by q; 2 x 6, row-major */
rapkm_2rrr_rr_status rapkm_2rrr_rr_task_jacobian(const double q[6], const rapkm_2rrr_rr_params *p, double x_q[12]);

/** q(x): the configuration with these coordinates of the task, or nearest to them, on the branch of q; length 6 */
rapkm_2rrr_rr_status rapkm_2rrr_rr_configuration_from_task(const double x_t[2], const double q[6], const rapkm_2rrr_rr_params *p, double q_result[6]);

/** q̇(ẋ): the admissible velocity with these rates of the task, or nearest to them; length 6 */
rapkm_2rrr_rr_status rapkm_2rrr_rr_velocity_from_task(const double q[6], const double xd_t[2], const rapkm_2rrr_rr_params *p, double qd_result[6]);

/** q̈(ẍ): the admissible acceleration with these ones of the task, or nearest to them, at that velocity; length 6 */
rapkm_2rrr_rr_status rapkm_2rrr_rr_acceleration_from_task(const double q[6], const double xd_t[2], const double xdd_t[2], const rapkm_2rrr_rr_params *p, double qdd_result[6]);

/** u: the smallest inputs that produce the motion, (27); length 3 */
rapkm_2rrr_rr_status rapkm_2rrr_rr_inverse_dynamics(const double q[6], const double qd[6], const double qdd[6], const rapkm_2rrr_rr_params *p, double u[3]);

/** F Fᵀ(τ − M u): the force no input can supply; length 6 */
rapkm_2rrr_rr_status rapkm_2rrr_rr_inverse_dynamics_residual(const double q[6], const double qd[6], const double qdd[6], const rapkm_2rrr_rr_params *p, double residual[6]);

/** q̈: accelerations under the inputs, (15); length 6 */
rapkm_2rrr_rr_status rapkm_2rrr_rr_forward_dynamics(const double q[6], const double qd[6], const double u[3], const rapkm_2rrr_rr_params *p, double qdd[6]);

/** λ: Lagrange multipliers; the reaction on the system is −Bᵀλ, (14); length 4 */
rapkm_2rrr_rr_status rapkm_2rrr_rr_multipliers(const double q[6], const double qd[6], const double u[3], const rapkm_2rrr_rr_params *p, double lambda_B[4]);

/** T, U: kinetic and potential energy; length 2 */
rapkm_2rrr_rr_status rapkm_2rrr_rr_energy(const double q[6], const double qd[6], const rapkm_2rrr_rr_params *p, double T_U[2]);

/** σ: distances from constraint and input singularities, 0 to 1; length 2 */
rapkm_2rrr_rr_status rapkm_2rrr_rr_singularity(const double q[6], const rapkm_2rrr_rr_params *p, double measure[2]);

#ifdef __cplusplus
}
#endif

#endif
