/* The circle of the paper's Figs. 4 to 7: once round in 1 s, from rest to rest. */
#ifndef TRAJECTORY_H
#define TRAJECTORY_H

#include "rapkm_2rrr_rr_f.h"

#define DURATION 1.0f

/*
 * Desired angles, rates and accelerations at time t of all joints, from the place of the end-effector: on the branch of
 * the configuration that was desired last.  On a status other than 0, which is returned, that one stays.
 */
rapkm_2rrr_rr_status trajectory(float t, const rapkm_2rrr_rr_params_f *p, float q[6], float qd[6], float qdd[6]);

/* How far the end-effector is from where it should be at time t. */
float off_the_circle(float t, const rapkm_2rrr_rr_params_f *p, const float q[6]);

#endif
