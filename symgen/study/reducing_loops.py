"""C that keeps what rows of values are reduced to: the same bits whatever vectors a compiler makes of it."""

from __future__ import annotations

# Bins of the histogram that quantiles of a point are read from.
BINS = 256
# Values that are reduced side by side: with fewer, compilers make no vectors of them.
ROW_LANES = 16
REDUCTIONS = """\
/* Where the first value of a magnitude is: one by one only within the piece that has it. */
static int64_t study_place(size_t count, const double *x, double size)
{
    size_t start = 0, piece = 0;
    for (; start + 32 <= count && !piece; start += 32) {
        for (size_t k = 0; k < 32; ++k) {
            piece += fabs(x[start + k]) == size;
        }
    }
    for (size_t k = piece ? start - 32 : start; k < count; ++k) {
        if (fabs(x[k]) == size) {
            return (int64_t)k;
        }
    }
    return -1;
}

/* Largest, smallest, sum, sum of squares and number of the values of a row.  Lanes, added up in their order: the
 * same bits with any vectors, and whether numbers are looked for among the values or not. */
static void study_figures(size_t count, const double *x, int numbers_only, double *figure)
{
    double high[ROW_LANES], low[ROW_LANES], sum[ROW_LANES], squares[ROW_LANES], numbers[ROW_LANES];
    for (size_t l = 0; l < ROW_LANES; ++l) {
        high[l] = -INFINITY;
        low[l] = INFINITY;
        sum[l] = squares[l] = numbers[l] = 0.0;
    }
    size_t k = 0;
    if (numbers_only) {
        for (; k + ROW_LANES <= count; k += ROW_LANES) {
            for (size_t l = 0; l < ROW_LANES; ++l) {
                const double v = x[k + l];
                high[l] = v > high[l] ? v : high[l];
                low[l] = v < low[l] ? v : low[l];
                sum[l] += v;
                squares[l] += v * v;
            }
        }
        numbers[0] = (double)k;
    } else {
        for (; k + ROW_LANES <= count; k += ROW_LANES) {
            for (size_t l = 0; l < ROW_LANES; ++l) {
                const double v = x[k + l], one = v == v ? 1.0 : 0.0, w = v == v ? v : 0.0;
                high[l] = v > high[l] ? v : high[l];
                low[l] = v < low[l] ? v : low[l];
                sum[l] += w;
                squares[l] += w * w;
                numbers[l] += one;
            }
        }
    }
    for (; k < count; ++k) {
        const double v = x[k];
        if (v == v || numbers_only) {
            high[0] = v > high[0] ? v : high[0];
            low[0] = v < low[0] ? v : low[0];
            sum[0] += v;
            squares[0] += v * v;
            numbers[0] += 1.0;
        }
    }
    for (size_t l = 1; l < ROW_LANES; ++l) {
        high[0] = high[l] > high[0] ? high[l] : high[0];
        low[0] = low[l] < low[0] ? low[l] : low[0];
        sum[0] += sum[l];
        squares[0] += squares[l];
        numbers[0] += numbers[l];
    }
    figure[0] = high[0];
    figure[1] = low[0];
    figure[2] = sum[0];
    figure[3] = squares[0];
    figure[4] = numbers[0];
}

/* The smallest magnitude of the values of a row. */
static double study_nearest(size_t count, const double *x)
{
    double near[ROW_LANES];
    for (size_t l = 0; l < ROW_LANES; ++l) {
        near[l] = INFINITY;
    }
    size_t k = 0;
    for (; k + ROW_LANES <= count; k += ROW_LANES) {
        for (size_t l = 0; l < ROW_LANES; ++l) {
            const double size = fabs(x[k + l]);
            near[l] = size < near[l] ? size : near[l];
        }
    }
    for (; k < count; ++k) {
        near[0] = fabs(x[k]) < near[0] ? fabs(x[k]) : near[0];
    }
    for (size_t l = 1; l < ROW_LANES; ++l) {
        near[0] = near[l] < near[0] ? near[l] : near[0];
    }
    return near[0];
}

/* Of the first values of each row that are numbers: largest, smallest, sum, sum of squares, how many; the smallest
 * magnitude, or else the largest, and where it is.  Where all are numbers their sum is one, unless infinite ones
 * cancel. */
void study_reduced(size_t rows, size_t count, size_t stride, size_t smallest, const double *values, double *figures,
                   int64_t *places)
{
    for (size_t row = 0; row < rows; ++row) {
        const double *x = values + row * stride;
        double *figure = figures + 6 * row;
        study_figures(count, x, 1, figure);
        if (figure[2] != figure[2]) {
            study_figures(count, x, 0, figure);
        }
        const double far = figure[0] > -figure[1] ? figure[0] : -figure[1];
        figure[5] = smallest ? study_nearest(count, x) : far;
        places[row] = figure[4] > 0.0 ? study_place(count, x, figure[5]) : -1;
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
