/* Groups of angles against one angle at a time: the bits of sines and cosines, not-a-number apart. */
#include SOURCE

#include <stdio.h>
#include <string.h>

static unsigned long long state = 88172645463325252ULL;

static REAL draw(const REAL width)
{
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return width * ((REAL)(state >> 40) / (REAL)8388608 - (REAL)1);
}

static int same(const REAL a, const REAL b)
{
    return (a != a && b != b) || memcmp(&a, &b, sizeof a) == 0;
}

int main(void)
{
    unsigned long different = 0, compared = 0;
    for (int count = 1; count <= 9; ++count) {
        for (int round = 0; round < 2000; ++round) {
            REAL angle[12], sine[12], cosine[12];
            for (int i = 0; i < 12; ++i) {
                angle[i] = draw(i % 2 ? (REAL)90 : (REAL)1);
            }
            angle[round % 12] = round % 5 ? angle[round % 12] : (REAL)NAN;
            angle[round % 7] = round % 3 ? angle[round % 7] : (REAL)INFINITY;
            angle[round % 11] = round % 4 ? angle[round % 11] : (REAL)0;
            GROUP(count, angle, sine, cosine);
            for (int i = 0; i < count; ++i) {
                REAL s, c;
                PAIR(angle[i], &s, &c);
                different += !same(s, sine[i]) || !same(c, cosine[i]);
                ++compared;
            }
        }
    }
    printf("%lu %lu\n", different, compared);
    return 0;
}
