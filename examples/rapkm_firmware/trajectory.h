/* The circle of the paper's Figs. 4 to 7: once round in 1 s, from rest to rest. */
#ifndef TRAJECTORY_H
#define TRAJECTORY_H

#include "rapkm_2rrr_rr_f.h"

#define DURATION 1.0f

/* Desired angles, rates and accelerations at time t: the inverse kinematics of the three arms. */
void trajectory(float t, const rapkm_2rrr_rr_params_f *p, float q[6], float qd[6], float qdd[6]);

/* The end-effector by the first arm. */
void end_effector(const rapkm_2rrr_rr_params_f *p, const float q[6], float tip[2]);

#endif
