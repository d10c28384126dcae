"""C that keeps what rows of values are reduced to: the same bits whatever vectors a compiler makes of it."""

from __future__ import annotations

# Bins of the histogram that quantiles of a point are read from.
BINS = 256
REDUCTIONS = """\
/* Largest, smallest, sum, sum of squares, number and smallest magnitude of the values of each row that are numbers;
 * and where the largest and the smallest magnitude are.  Eight lanes, added up in their order: the same bits with any
 * vectors. */
void study_reduced(size_t rows, size_t count, const double *values, double *figures, int64_t *places)
{
    for (size_t row = 0; row < rows; ++row) {
        const double *x = values + row * count;
        double high[8], low[8], sum[8], squares[8], numbers[8], near[8];
        for (size_t l = 0; l < 8; ++l) {
            high[l] = -INFINITY;
            low[l] = near[l] = INFINITY;
            sum[l] = squares[l] = numbers[l] = 0.0;
        }
        size_t k = 0;
        for (; k + 8 <= count; k += 8) {
            for (size_t l = 0; l < 8; ++l) {
                const double v = x[k + l], one = v == v ? 1.0 : 0.0, w = v == v ? v : 0.0, size = fabs(v);
                high[l] = v > high[l] ? v : high[l];
                low[l] = v < low[l] ? v : low[l];
                near[l] = size < near[l] ? size : near[l];
                sum[l] += w;
                squares[l] += w * w;
                numbers[l] += one;
            }
        }
        for (; k < count; ++k) {
            const double v = x[k], size = fabs(v);
            if (v == v) {
                high[0] = v > high[0] ? v : high[0];
                low[0] = v < low[0] ? v : low[0];
                near[0] = size < near[0] ? size : near[0];
                sum[0] += v;
                squares[0] += v * v;
                numbers[0] += 1.0;
            }
        }
        for (size_t l = 1; l < 8; ++l) {
            high[0] = high[l] > high[0] ? high[l] : high[0];
            low[0] = low[l] < low[0] ? low[l] : low[0];
            near[0] = near[l] < near[0] ? near[l] : near[0];
            sum[0] += sum[l];
            squares[0] += squares[l];
            numbers[0] += numbers[l];
        }
        double *figure = figures + 6 * row;
        figure[0] = high[0];
        figure[1] = low[0];
        figure[2] = sum[0];
        figure[3] = squares[0];
        figure[4] = numbers[0];
        figure[5] = near[0];
        const double far = high[0] > -low[0] ? high[0] : -low[0];
        int64_t *place = places + 2 * row;
        place[0] = place[1] = -1;
        for (k = 0; k < count && numbers[0] > 0.0 && place[0] < 0; ++k) {
            place[0] = fabs(x[k]) == far ? (int64_t)k : -1;
        }
        for (k = 0; k < count && numbers[0] > 0.0 && place[1] < 0; ++k) {
            place[1] = fabs(x[k]) == near[0] ? (int64_t)k : -1;
        }
    }
}

/* Quantiles of each row by a histogram between its ends; values are spread evenly within a bin. */
void study_quantiles(size_t rows, size_t count, const double *values, const double *figures, size_t levels,
                     const double *level, double *result)
{
    for (size_t row = 0; row < rows; ++row) {
        const double *x = values + row * count, *figure = figures + 6 * row;
        const double low = figure[1], width = figure[0] - low, scale = width > 0.0 ? BINS / width : 0.0;
        double bins[BINS] = {0.0};
        for (size_t k = 0; k < count; ++k) {
            if (x[k] == x[k]) {
                const size_t bin = (size_t)((x[k] - low) * scale);
                bins[bin < BINS ? bin : BINS - 1] += 1.0;
            }
        }
        for (size_t i = 0; i < levels; ++i) {
            double below = 0.0;
            const double wanted = level[i] * figure[4];
            size_t bin = 0;
            while (bin < BINS - 1 && below + bins[bin] < wanted) {
                below += bins[bin];
                ++bin;
            }
            const double inside = bins[bin] > 0.0 ? (wanted - below) / bins[bin] : 0.0;
            result[row * levels + i] = figure[4] > 0.0 ? low + width * (((double)bin + inside) / BINS) : NAN;
        }
    }
}
"""
