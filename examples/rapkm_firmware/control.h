/* What every controller of this folder provides; control_step is what a 1 kHz interrupt would call. */
#ifndef CONTROL_H
#define CONTROL_H

#include <stdbool.h>

#include "rapkm_2rrr_rr_f.h"

#define JOINTS 6
#define DRIVES 3

extern const char control_name[];

/*
 * Torques u at time t from measured angles and rates of the drives, limited to what the drives can do.
 * On a status other than 0, which is returned, they are not computed: the caller decides what to do.
 */
rapkm_2rrr_rr_status control_step(float t, const float angles[DRIVES], const float rates[DRIVES], float u[DRIVES]);

/* A property of the model the controller relies on, tested at a state of the plant; prints what it finds. */
bool control_check(const double q[JOINTS], const double qd[JOINTS]);

/* u within the limits of the drives (symmetric here), all scaled alike so that their direction stays. */
void control_limit(const rapkm_2rrr_rr_params_f *p, float u[DRIVES]);

#endif
