#include "trajectory.h"

#include <math.h>
#include <string.h>

#define TAU 6.28318531f
#define RADIUS 0.12f
#define START (-TAU / 12.0f)

/* Where the last desired configuration was: the end-effector in the middle, all elbows bent alike, at first. */
static float planned[6] = {-0.4317f, 1.6627f, -2.5261f, 1.9106f, 1.9106f, 1.9107f};

typedef struct {
    float position[2], rate[2], acceleration[2];
} point_t;

/* Once round the centroid of the base triangle, with zero rate and acceleration at both ends. */
static point_t on_circle(float t, const rapkm_2rrr_rr_params_f *p) {
    const float s = t < 0.0f ? 0.0f : t > DURATION ? 1.0f : t / DURATION;
    const float turned = s * s * s * (10.0f + s * (6.0f * s - 15.0f));
    const float speed = 30.0f * s * s * (1.0f + s * (s - 2.0f)) / DURATION;
    const float push = 60.0f * s * (1.0f + s * (2.0f * s - 3.0f)) / (DURATION * DURATION);
    const float angle = TAU * turned + START;
    const float c = RADIUS * cosf(angle);
    const float d = RADIUS * sinf(angle);
    const float w = TAU * speed;
    const float a = TAU * push;
    const point_t point = {
        {(p->x_1 + p->x_2 + p->x_3) / 3.0f + c, (p->y_1 + p->y_2 + p->y_3) / 3.0f + d},
        {-w * d, w * c},
        {-a * d - w * w * c, a * c - w * w * d}};
    return point;
}

rapkm_2rrr_rr_status trajectory(float t, const rapkm_2rrr_rr_params_f *p, float q[6], float qd[6], float qdd[6]) {
    const point_t point = on_circle(t, p);
    rapkm_2rrr_rr_status status = rapkm_2rrr_rr_configuration_from_task_f(point.position, planned, p, planned);
    if (status != RAPKM_2RRR_RR_OK) {
        return status;
    }
    memcpy(q, planned, sizeof planned);
    status = rapkm_2rrr_rr_velocity_from_task_f(q, point.rate, p, qd);
    if (status != RAPKM_2RRR_RR_OK) {
        return status;
    }
    return rapkm_2rrr_rr_acceleration_from_task_f(q, point.rate, point.acceleration, p, qdd);
}

float off_the_circle(float t, const rapkm_2rrr_rr_params_f *p, const float q[6]) {
    const point_t point = on_circle(t, p);
    float tip[2];
    if (rapkm_2rrr_rr_task_position_f(q, p, tip) != RAPKM_2RRR_RR_OK) {
        return INFINITY;
    }
    return hypotf(tip[0] - point.position[0], tip[1] - point.position[1]);
}
