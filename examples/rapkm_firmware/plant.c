#include "plant.h"

#define JOINTS 6
#define SUBSTEPS 2

static bool rates(const plant_t *plant, const double q[JOINTS], const double qd[JOINTS], const double u[3],
                  double qdd[JOINTS]) {
    return rapkm_2rrr_rr_forward_dynamics(q, qd, u, &plant->p, qdd) == RAPKM_2RRR_RR_OK;
}

/* Back onto the constraints, which integration leaves by its own error. */
static bool project(plant_t *plant) {
    return rapkm_2rrr_rr_projected_configuration(plant->q, &plant->p, plant->q) == RAPKM_2RRR_RR_OK &&
           rapkm_2rrr_rr_admissible_velocity(plant->q, plant->qd, &plant->p, plant->qd) == RAPKM_2RRR_RR_OK;
}

/* One step of the classical Runge-Kutta method. */
static bool advance(plant_t *plant, const double u[3], double h) {
    static const double share[4] = {0.0, 0.5, 0.5, 1.0};
    static const double weight[4] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
    double v[JOINTS] = {0}, a[JOINTS] = {0}, dq[JOINTS] = {0}, dqd[JOINTS] = {0};
    for (int stage = 0; stage < 4; stage++) {
        double q[JOINTS], qd[JOINTS];
        for (int i = 0; i < JOINTS; i++) {
            q[i] = plant->q[i] + share[stage] * h * v[i];
            qd[i] = plant->qd[i] + share[stage] * h * a[i];
        }
        if (!rates(plant, q, qd, u, a)) {
            return false;
        }
        for (int i = 0; i < JOINTS; i++) {
            v[i] = qd[i];
            dq[i] += weight[stage] * v[i];
            dqd[i] += weight[stage] * a[i];
        }
    }
    for (int i = 0; i < JOINTS; i++) {
        plant->q[i] += h * dq[i];
        plant->qd[i] += h * dqd[i];
    }
    return project(plant);
}

bool plant_start(plant_t *plant, const float q[JOINTS]) {
    plant->p = rapkm_2rrr_rr_default_params();
    for (int i = 0; i < JOINTS; i++) {
        plant->q[i] = (double)q[i];
        plant->qd[i] = 0.0;
    }
    return project(plant) && project(plant);
}

bool plant_step(plant_t *plant, const float u[3], double seconds) {
    const double held[3] = {(double)u[0], (double)u[1], (double)u[2]};
    for (int k = 0; k < SUBSTEPS; k++) {
        if (!advance(plant, held, seconds / SUBSTEPS)) {
            return false;
        }
    }
    return true;
}
