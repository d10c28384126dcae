/* Every STRIDE-th float32: the generated pair against the library's double precision, which is exact enough. */
#include SOURCE

#include <stdint.h>
#include <stdio.h>
#include <string.h>

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

/* The error in units of the last place of the exact value. */
static double ulps(const float found, const double exact)
{
    int exponent;
    frexp(exact, &exponent);
    return fabs((double)found - exact) / ldexp(1.0, exponent > -125 ? exponent - 24 : -149);
}

static void largest(double *worst, const double value)
{
    if (!(value <= *worst)) {
        *worst = value;
    }
}

int main(void)
{
    double sine_ulps = 0.0, cosine_ulps = 0.0, near = 0.0, far = 0.0;
    unsigned long asymmetric = 0;
    for (uint32_t bits = 0; bits <= to_bits(LIMIT); bits += STRIDE) {
        const float x = from_bits(bits);
        float sine, cosine, minus_sine, minus_cosine;
        PAIR(x, &sine, &cosine);
        PAIR(-x, &minus_sine, &minus_cosine);
        asymmetric += minus_sine != -sine || to_bits(minus_cosine) != to_bits(cosine);
        const double exact_sine = sin((double)x), exact_cosine = cos((double)x);
        if (bits <= to_bits(12.566371f) && bits > 0) {
            largest(&sine_ulps, ulps(sine, exact_sine));
            largest(&cosine_ulps, ulps(cosine, exact_cosine));
        }
        double *error = bits <= to_bits(100.0f) ? &near : &far;
        largest(error, fabs((double)sine - exact_sine));
        largest(error, fabs((double)cosine - exact_cosine));
    }
    printf("%.6f %.6f %.6e %.6e %lu\n", sine_ulps, cosine_ulps, near, far, asymmetric);
    return 0;
}
