/* The manipulator itself, as symgen's forward dynamics in double precision sees it. */
#ifndef PLANT_H
#define PLANT_H

#include <stdbool.h>

#include "rapkm_2rrr_rr.h"

typedef struct {
    rapkm_2rrr_rr_params p;
    double q[6], qd[6];
} plant_t;

/* On the constraints near q, at rest. */
bool plant_start(plant_t *plant, const float q[6]);

/* Constant torques for a time; false where the accelerations are not determined. */
bool plant_step(plant_t *plant, const float u[3], double seconds);

#endif
