/* Where the manipulator is, from the encoders of its three drives. */
#ifndef ENCODERS_H
#define ENCODERS_H

#include "rapkm_2rrr_rr_f.h"

/* About where it is before the first step. */
void encoders_start(const float q[6]);

/*
 * Angles and rates of all joints that are nearest to those of the drives, from where the last step left them.
 * On a status other than 0, which is returned, the next step starts from there once more.
 */
rapkm_2rrr_rr_status encoders_read(const rapkm_2rrr_rr_params_f *p, const float angles[3], const float rates[3],
                                   float q[6], float qd[6]);

#endif
