/* Tracks the circle at 1 kHz: measures, controls, lets the plant move, and tells how well that went. */
#include <math.h>

#include "board.h"
#include "control.h"
#include "encoders.h"
#include "plant.h"
#include "trajectory.h"

#define RATE 1000                   /* Hz */
#define STEPS 1200                  /* the motion, then rest */
#define PROCESSOR 168e6             /* Hz, of the microcontroller the headroom is told for */
#define ENCODER (6.28318531 / 65536.0) /* rad, of the angles */
#define GYRO 1e-3                   /* rad/s, of the rates */
#define PAYLOAD 0.12                /* kg that the plant carries; the controller believes 0.1 */
#define LOST_FROM 300               /* the first encoder is lost for a few steps */
#define LOST_TO 305
#define MOST_ERROR 1e-3             /* m */
#define ROUNDING 0.99999f           /* the kernel keeps limits up to rounding: no reason to speak of a limit */

static int limited;

void control_limit(const rapkm_2rrr_rr_params_f *p, float u[DRIVES]) {
    const float limit[DRIVES] = {p->limit_drive_1_upper, p->limit_drive_2_upper, p->limit_drive_3_upper};
    float share = 1.0f;
    for (int k = 0; k < DRIVES; k++) {
        share = fminf(share, limit[k] / fmaxf(fabsf(u[k]), limit[k]));
    }
    if (share < ROUNDING) {
        limited++;
    }
    for (int k = 0; k < DRIVES; k++) {
        u[k] *= share;
    }
}

static void measure(const plant_t *plant, int step, float angles[DRIVES], float rates[DRIVES]) {
    for (int k = 0; k < DRIVES; k++) { /* the first three joints are the driven ones */
        angles[k] = (float)(ENCODER * floor(plant->q[k] / ENCODER + 0.5));
        rates[k] = (float)(GYRO * floor(plant->qd[k] / GYRO + 0.5));
    }
    if (step >= LOST_FROM && step < LOST_TO) {
        angles[0] = NAN;
    }
}

static double tracking_error(const plant_t *plant, const rapkm_2rrr_rr_params_f *p, float t) {
    float q[JOINTS];
    for (int i = 0; i < JOINTS; i++) {
        q[i] = (float)plant->q[i];
    }
    return (double)off_the_circle(t, p, q);
}

static void tell(const char *what, double value, int decimals, const char *unit) {
    board_print(what);
    board_print_number(value, decimals);
    board_print(unit);
}

int main(void) {
    const rapkm_2rrr_rr_params_f p = rapkm_2rrr_rr_default_params_f();
    float q[JOINTS], qd[JOINTS], qdd[JOINTS], angles[DRIVES], rates[DRIVES], u[DRIVES] = {0};
    plant_t plant;
    bool good = trajectory(0.0f, &p, q, qd, qdd) == RAPKM_2RRR_RR_OK && plant_start(&plant, q);
    encoders_start(q);
    plant.p.m_payload = PAYLOAD;
    double largest = 0.0, squares = 0.0, worst = 0.0, torque = 0.0;
    int held = 0;
    board_start_ticks();
    for (int step = 0; step < STEPS && good; step++) {
        const float t = (float)step / RATE;
        measure(&plant, step, angles, rates);
        const uint32_t before = board_ticks();
        const rapkm_2rrr_rr_status status = control_step(t, angles, rates, u);
        const double instructions = board_instructions(before, board_ticks());
        worst = fmax(worst, instructions);
        if (status != RAPKM_2RRR_RR_OK) {
            held++; /* the torques of the step before are kept: right for a few milliseconds, not for longer */
        }
        for (int k = 0; k < DRIVES; k++) {
            torque = fmax(torque, fabs((double)u[k]));
        }
        if (step == RATE / 2) {
            good = control_check(plant.q, plant.qd);
        }
        good = plant_step(&plant, u, 1.0 / RATE) && good;
        const double error = tracking_error(&plant, &p, (float)(step + 1) / RATE);
        largest = fmax(largest, error);
        squares += error * error;
    }
    board_print(control_name);
    tell(": tracking error ", 1e6 * largest, 1, " um at most, ");
    tell("", 1e6 * sqrt(squares / STEPS), 1, " um rms\n");
    tell("largest torque ", torque, 3, " N m");
    tell(", limited in ", limited, 0, " steps");
    tell(", held in ", held, 0, " steps without a measurement\n");
    tell("worst step ", worst, 0, " instructions: ");
    tell("", 100.0 * (1.0 - worst * RATE / PROCESSOR), 2, " % of the time is left at 168 MHz and one a cycle\n");
    good = good && largest < MOST_ERROR && torque <= (double)p.limit_drive_1_upper * 1.000001 && held == LOST_TO - LOST_FROM;
    board_print(good ? "passed\n" : "failed\n");
    return good ? 0 : 1;
}
