#include "trajectory.h"

#include <math.h>

#define TAU 6.28318531f
#define RADIUS 0.12f
#define START (-TAU / 12.0f)

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

/* One arm: base angle a and elbow angle b > 0 that put its tip on the point, with rates and accelerations. */
static void arm(const point_t *point, float x, float y, float l_1, float l_2, float angle[2], float rate[2],
                float acceleration[2]) {
    const float dx = point->position[0] - x;
    const float dy = point->position[1] - y;
    const float cosine = (dx * dx + dy * dy - l_1 * l_1 - l_2 * l_2) / (2.0f * l_1 * l_2);
    angle[1] = acosf(cosine);
    angle[0] = atan2f(dy, dx) - atan2f(l_2 * sinf(angle[1]), l_1 + l_2 * cosf(angle[1]));
    /* the links as vectors: their sum follows the point */
    const float first[2] = {l_1 * cosf(angle[0]), l_1 * sinf(angle[0])};
    const float second[2] = {l_2 * cosf(angle[0] + angle[1]), l_2 * sinf(angle[0] + angle[1])};
    const float area = first[0] * second[1] - first[1] * second[0];
    /* rates of the links from -w_1 first_y - w_2 second_y = x_dot, w_1 first_x + w_2 second_x = y_dot */
    const float w_1 = (second[0] * point->rate[0] + second[1] * point->rate[1]) / area;
    const float w_2 = -(first[0] * point->rate[0] + first[1] * point->rate[1]) / area;
    const float ax = point->acceleration[0] + w_1 * w_1 * first[0] + w_2 * w_2 * second[0];
    const float ay = point->acceleration[1] + w_1 * w_1 * first[1] + w_2 * w_2 * second[1];
    const float e_1 = (second[0] * ax + second[1] * ay) / area;
    const float e_2 = -(first[0] * ax + first[1] * ay) / area;
    rate[0] = w_1;
    rate[1] = w_2 - w_1;
    acceleration[0] = e_1;
    acceleration[1] = e_2 - e_1;
}

void trajectory(float t, const rapkm_2rrr_rr_params_f *p, float q[6], float qd[6], float qdd[6]) {
    const point_t point = on_circle(t, p);
    const float x[3] = {p->x_1, p->x_2, p->x_3};
    const float y[3] = {p->y_1, p->y_2, p->y_3};
    for (int k = 0; k < 3; k++) {
        float angle[2], rate[2], acceleration[2];
        arm(&point, x[k], y[k], p->l_1, p->l_2, angle, rate, acceleration);
        for (int link = 0; link < 2; link++) {
            q[k + 3 * link] = angle[link];
            qd[k + 3 * link] = rate[link];
            qdd[k + 3 * link] = acceleration[link];
        }
    }
}

void end_effector(const rapkm_2rrr_rr_params_f *p, const float q[6], float tip[2]) {
    tip[0] = p->x_1 + p->l_1 * cosf(q[0]) + p->l_2 * cosf(q[0] + q[3]);
    tip[1] = p->y_1 + p->l_1 * sinf(q[0]) + p->l_2 * sinf(q[0] + q[3]);
}
