/*
 * Every STRIDE-th float32: the generated pair against a sine and cosine in double precision.
 *
 * Written in blocks that compilers turn into vector code: a library call per number takes ten times as long. What they
 * are compared with is itself compared with the library at every CONTROL-th number.
 */
#include SOURCE

#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { BLOCK = 512, CONTROL = 1021 };

/* Largest errors by place in a block, so that no maximum waits for another. */
typedef struct {
    double sine_ulps[BLOCK];
    double cosine_ulps[BLOCK];
    double distance[BLOCK];
} Worst;

static unsigned long asymmetric, uncontrolled, compared;

static float from_bits(const uint32_t bits)
{
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static uint32_t to_bits(const float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

/* pi/2 in parts: multiples of the first two up to 2^20 are exact, and what rounds later is relative to what is left. */
static void reference(const double x, double *sine, double *cosine)
{
    const double rounder = 0x1.8p52;
    const double k = (x * 0x1.45f306dc9c883p-1 + rounder) - rounder;
    const double r = ((x - k * 0x1.921fb544p+0) - k * 0x1.0b4611a6p-34) - k * 0x1.3198a2e037073p-69;
    const double z = r * r;
    const double s = r + r * z * (-1.0 / 6.0 + z * (1.0 / 120.0 + z * (-1.0 / 5040.0 + z * (1.0 / 362880.0
        + z * (-1.0 / 39916800.0 + z * (1.0 / 6227020800.0 + z * (-1.0 / 1307674368000.0
        + z * (1.0 / 355687428096000.0))))))));
    const double c = 1.0 + z * (-1.0 / 2.0 + z * (1.0 / 24.0 + z * (-1.0 / 720.0 + z * (1.0 / 40320.0
        + z * (-1.0 / 3628800.0 + z * (1.0 / 479001600.0 + z * (-1.0 / 87178291200.0
        + z * (1.0 / 20922789888000.0))))))));
    const double m = k - ((k + 4.0 * rounder) - 4.0 * rounder); /* of the quadrant: -2 to 2 */
    const double keep = 1.0 - fabs(m), turn = m * (2.0 - fabs(m));
    *sine = keep * s + turn * c;
    *cosine = keep * c - turn * s;
}

/* What one unit in the last place of float32 is there, for each of the values. */
static void units(const unsigned size, const double *values, double *unit)
{
    static uint64_t bits[BLOCK];
    memcpy(bits, values, size * sizeof bits[0]);
    for (unsigned j = 0; j < size; j++) {
        bits[j] &= 0x7ff0000000000000u;
    }
    memcpy(unit, bits, size * sizeof bits[0]);
    for (unsigned j = 0; j < size; j++) {
        unit[j] = (unit[j] < 0x1p-126 ? 0x1p-126 : unit[j]) * 0x1p-23;
    }
}

static double larger(const double a, const double b)
{
    return a < b ? b : a;
}

static void compare(const uint32_t first, const unsigned size, Worst *worst)
{
    static float x[BLOCK], sine[BLOCK], cosine[BLOCK], minus_sine[BLOCK], minus_cosine[BLOCK];
    static double exact_sine[BLOCK], exact_cosine[BLOCK], sine_unit[BLOCK], cosine_unit[BLOCK];
    for (unsigned j = 0; j < size; j++) {
        x[j] = from_bits(first + j * STRIDE);
    }
    for (unsigned j = 0; j < size; j++) {
        PAIR(x[j], &sine[j], &cosine[j]);
    }
    for (unsigned j = 0; j < size; j++) {
        PAIR(-x[j], &minus_sine[j], &minus_cosine[j]);
    }
    for (unsigned j = 0; j < size; j++) {
        reference((double)x[j], &exact_sine[j], &exact_cosine[j]);
    }
    uint32_t different = 0;
    for (unsigned j = 0; j < size; j++) { /* numbers that are none differ from themselves */
        different += (uint32_t)(minus_sine[j] != -sine[j]) | (uint32_t)(minus_cosine[j] != cosine[j]);
    }
    asymmetric += different;
    compared += size;
    units(size, exact_sine, sine_unit);
    units(size, exact_cosine, cosine_unit);
    for (unsigned j = 0; j < size; j++) {
        const double off = fabs((double)sine[j] - exact_sine[j]);
        worst->sine_ulps[j] = larger(worst->sine_ulps[j], off / sine_unit[j]);
        worst->distance[j] = larger(worst->distance[j], off);
    }
    for (unsigned j = 0; j < size; j++) {
        const double off = fabs((double)cosine[j] - exact_cosine[j]);
        worst->cosine_ulps[j] = larger(worst->cosine_ulps[j], off / cosine_unit[j]);
        worst->distance[j] = larger(worst->distance[j], off);
    }
    for (unsigned j = (CONTROL - first % CONTROL) % CONTROL; j < size; j += CONTROL) {
        const double a = sin((double)x[j]), b = cos((double)x[j]);
        uncontrolled += !(fabs(exact_sine[j] - a) <= 0x1p-50 * fabs(a) && fabs(exact_cosine[j] - b) <= 0x1p-50 * fabs(b));
    }
}

/* All numbers from *next to the last one; the next is where the stride goes on. */
static void sweep(uint32_t *next, const float last, Worst *worst)
{
    while (*next <= to_bits(last)) {
        const uint32_t left = (to_bits(last) - *next) / STRIDE + 1u;
        const unsigned size = left < BLOCK ? left : BLOCK;
        compare(*next, size, worst);
        *next += size * STRIDE;
    }
}

static double largest(const double errors[BLOCK])
{
    double worst = 0.0;
    for (unsigned j = 0; j < BLOCK; j++) {
        worst = larger(worst, errors[j]);
    }
    return worst;
}

int main(void)
{
    static Worst turns, near, far; /* two turns, where relative errors count; up to 100; beyond */
    uint32_t next = 0;
    sweep(&next, 12.566371f, &turns);
    sweep(&next, 100.0f, &near);
    sweep(&next, LIMIT, &far);
    printf("%.6f %.6f ", largest(turns.sine_ulps), largest(turns.cosine_ulps));
    printf("%.6e %.6e ", larger(largest(turns.distance), largest(near.distance)), largest(far.distance));
    printf("%lu %lu %lu\n", asymmetric, uncontrolled, compared);
    return 0;
}
