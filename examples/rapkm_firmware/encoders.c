#include "encoders.h"

#include <string.h>

static float last[6];

void encoders_start(const float q[6]) {
    memcpy(last, q, sizeof last);
}

rapkm_2rrr_rr_status encoders_read(const rapkm_2rrr_rr_params_f *p, const float angles[3], const float rates[3],
                                   float q[6], float qd[6]) {
    rapkm_2rrr_rr_status status = rapkm_2rrr_rr_configuration_from_measured_f(angles, last, p, last);
    if (status == RAPKM_2RRR_RR_OK) {
        memcpy(q, last, sizeof last);
        status = rapkm_2rrr_rr_velocity_from_measured_f(q, rates, p, qd);
    }
    return status;
}
