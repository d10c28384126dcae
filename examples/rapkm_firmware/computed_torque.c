/*
 * Computed torque: the inverse dynamics at a desired acceleration that is corrected by position and rate errors.
 * Among the torques that produce it the model's `allocation` chooses: a preload, given up where limits need it.
 */
#include <math.h>

#include "control.h"
#include "encoders.h"
#include "trajectory.h"

#define STIFFNESS 3600.0f /* 1/s^2: errors die out like those of a critically damped oscillator with 60 rad/s */
#define DAMPING 120.0f    /* 1/s */

const char control_name[] = "computed torque";

rapkm_2rrr_rr_status control_step(float t, const float angles[DRIVES], const float rates[DRIVES], float u[DRIVES]) {
    const rapkm_2rrr_rr_params_f p = rapkm_2rrr_rr_default_params_f();
    float q[JOINTS], qd[JOINTS], wanted[JOINTS], wanted_rate[JOINTS], qdd[JOINTS];
    rapkm_2rrr_rr_status status = encoders_read(&p, angles, rates, q, qd);
    if (status != RAPKM_2RRR_RR_OK) {
        return status;
    }
    status = trajectory(t, &p, wanted, wanted_rate, qdd);
    if (status != RAPKM_2RRR_RR_OK) {
        return status;
    }
    for (int i = 0; i < JOINTS; i++) {
        const float error = remainderf(wanted[i] - q[i], 6.28318531f);
        qdd[i] += DAMPING * (wanted_rate[i] - qd[i]) + STIFFNESS * error;
    }
    status = rapkm_2rrr_rr_admissible_acceleration_f(q, qd, qdd, &p, qdd);
    if (status != RAPKM_2RRR_RR_OK) {
        return status;
    }
    status = rapkm_2rrr_rr_inverse_dynamics_f(q, qd, qdd, &p, u);
    if (status == RAPKM_2RRR_RR_OK) {
        control_limit(&p, u);
    }
    return status;
}

bool control_check(const double q[JOINTS], const double qd[JOINTS]) {
    (void)q;
    (void)qd;
    return true; /* nothing but the inverse dynamics is relied on */
}
