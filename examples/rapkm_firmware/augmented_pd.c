/*
 * Augmented PD control in redundant coordinates, with the projected matrices of Sec. 5.4:
 *   u = (N_B M)^+ (G~ qdd_d + C~ qd_d + Q~ - N_B (K_v e_dot + K_p e)),  e = q - q_d.
 * It is stable because d/dt G~ - 2 C~ is skew-symmetric, which control_check tests.
 */
#include <math.h>

#include "board.h"
#include "control.h"
#include "encoders.h"
#include "rapkm_2rrr_rr.h"
#include "trajectory.h"

#define STIFFNESS 8.0f /* N m/rad */
#define DAMPING 0.25f  /* N m s/rad */
#define WIDTH 1e-5     /* s, of the central difference that gives d/dt G~ */
#define SKEW 1e-6      /* of the largest entry of d/dt G~ and 2 C~ */

const char control_name[] = "augmented PD";

static void add_product(const float *matrix, const float *vector, int rows, int columns, float sign, float *sum) {
    for (int i = 0; i < rows; i++) {
        for (int j = 0; j < columns; j++) {
            sum[i] += sign * matrix[i * columns + j] * vector[j];
        }
    }
}

rapkm_2rrr_rr_status control_step(float t, const float angles[DRIVES], const float rates[DRIVES], float u[DRIVES]) {
    const rapkm_2rrr_rr_params_f p = rapkm_2rrr_rr_default_params_f();
    float q[JOINTS], qd[JOINTS], wanted[JOINTS], wanted_rate[JOINTS], wanted_acceleration[JOINTS];
    float matrix[JOINTS * JOINTS], force[JOINTS];
    rapkm_2rrr_rr_status status = encoders_read(&p, angles, rates, q, qd);
    if (status != RAPKM_2RRR_RR_OK) {
        return status;
    }
    status = trajectory(t, &p, wanted, wanted_rate, wanted_acceleration);
    if (status != RAPKM_2RRR_RR_OK) {
        return status;
    }
    status = rapkm_2rrr_rr_projected_potential_force_f(q, &p, force);
    if (status != RAPKM_2RRR_RR_OK) {
        return status;
    }
    status = rapkm_2rrr_rr_projected_mass_matrix_f(q, &p, matrix);
    if (status != RAPKM_2RRR_RR_OK) {
        return status;
    }
    add_product(matrix, wanted_acceleration, JOINTS, JOINTS, 1.0f, force);
    status = rapkm_2rrr_rr_projected_coriolis_matrix_f(q, qd, &p, matrix);
    if (status != RAPKM_2RRR_RR_OK) {
        return status;
    }
    add_product(matrix, wanted_rate, JOINTS, JOINTS, 1.0f, force);
    float correction[JOINTS];
    for (int i = 0; i < JOINTS; i++) {
        const float error = remainderf(q[i] - wanted[i], 6.28318531f);
        correction[i] = DAMPING * (qd[i] - wanted_rate[i]) + STIFFNESS * error;
    }
    status = rapkm_2rrr_rr_nullspace_projector_f(q, &p, matrix);
    if (status != RAPKM_2RRR_RR_OK) {
        return status;
    }
    add_product(matrix, correction, JOINTS, JOINTS, -1.0f, force);
    status = rapkm_2rrr_rr_projected_control_pseudoinverse_f(q, &p, matrix);
    if (status == RAPKM_2RRR_RR_OK) {
        for (int k = 0; k < DRIVES; k++) {
            u[k] = 0.0f;
        }
        add_product(matrix, force, DRIVES, JOINTS, 1.0f, u);
        control_limit(&p, u);
    }
    return status;
}

bool control_check(const double q[JOINTS], const double qd[JOINTS]) {
    const rapkm_2rrr_rr_params p = rapkm_2rrr_rr_default_params();
    double before[JOINTS], after[JOINTS], G_before[JOINTS * JOINTS], G_after[JOINTS * JOINTS], C[JOINTS * JOINTS];
    for (int i = 0; i < JOINTS; i++) {
        before[i] = q[i] - WIDTH * qd[i];
        after[i] = q[i] + WIDTH * qd[i];
    }
    if (rapkm_2rrr_rr_projected_mass_matrix(before, &p, G_before) != RAPKM_2RRR_RR_OK ||
        rapkm_2rrr_rr_projected_mass_matrix(after, &p, G_after) != RAPKM_2RRR_RR_OK ||
        rapkm_2rrr_rr_projected_coriolis_matrix(q, qd, &p, C) != RAPKM_2RRR_RR_OK) {
        return false;
    }
    double X[JOINTS * JOINTS], size = 0.0, symmetric = 0.0;
    for (int k = 0; k < JOINTS * JOINTS; k++) {
        const double G_dot = (G_after[k] - G_before[k]) / (2.0 * WIDTH);
        X[k] = G_dot - 2.0 * C[k];
        size = fmax(size, fmax(fabs(G_dot), fabs(2.0 * C[k])));
    }
    for (int i = 0; i < JOINTS; i++) {
        for (int j = 0; j < JOINTS; j++) {
            symmetric = fmax(symmetric, fabs(X[i * JOINTS + j] + X[j * JOINTS + i]));
        }
    }
    board_print("symmetric part of d/dt G~ - 2 C~: ");
    board_print_number(1e9 * symmetric / size, 1);
    board_print("e-9 of its size\n");
    return size > 0.0 && symmetric <= SKEW * size;
}
