#include <hedgerow/measure/fit.h>

#include <algorithm>
#include <cmath>

namespace hedgerow::measure {
namespace {

/// The term that the second parameter of a law multiplies.
double term(Law law, int dimension, double n) {
    switch (law) {
        case Law::power:
            return std::log(n);
        case Law::logarithm:
            return std::log2(n);
        case Law::root:
            return dimension == 2 ? std::sqrt(n) : std::cbrt(n);
        case Law::linear:
            return n;
        case Law::n_log_n:
            break;
    }
    return n * std::log2(n);
}

/// Weighted linear regression of y on x. Sums are about the means, which keeps rounding errors small.
struct Line {
    double a, b;
    Line(std::span<const double> x, std::span<const double> y, std::span<const double> weight) {
        double sum = 0, mean_x = 0, mean_y = 0, xx = 0, xy = 0;
        for (std::size_t i = 0; i < x.size(); ++i)
            sum += weight[i], mean_x += weight[i] * x[i], mean_y += weight[i] * y[i];
        mean_x /= sum, mean_y /= sum;
        for (std::size_t i = 0; i < x.size(); ++i) {
            xx += weight[i] * (x[i] - mean_x) * (x[i] - mean_x);
            xy += weight[i] * (x[i] - mean_x) * (y[i] - mean_y);
        }
        b = xx > 0 ? xy / xx : 0;
        a = mean_y - b * mean_x;
    }
};

}  // namespace

double Fit::operator()(double n) const {
    const double x = term(law, dimension, n);
    return law == Law::power ? a * std::exp(b * x) : a + b * x;
}

Fit fit(Law law, std::span<const double> sizes, std::span<const double> values, int dimension) {
    const bool power = law == Law::power;
    // Weights of 1/value² make errors relative; for the power law logarithms do.
    std::vector<double> x, y, weight;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        x.push_back(term(law, dimension, sizes[i]));
        y.push_back(power ? std::log(values[i]) : values[i]);
        weight.push_back(power ? 1 : 1 / (values[i] * values[i]));
    }
    const Line line(x, y, weight);
    Fit found{law, dimension, power ? std::exp(line.a) : line.a, line.b, 0};
    double sum = 0;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        const double error = found(sizes[i]) / values[i] - 1;
        sum += error * error;
    }
    found.residual = std::sqrt(sum / static_cast<double>(sizes.size()));
    return found;
}

std::vector<Fit> fits(std::span<const double> sizes, std::span<const double> values, int dimension) {
    std::vector<Fit> all;
    for (const Law law : {Law::power, Law::logarithm, Law::root, Law::linear, Law::n_log_n})
        all.push_back(fit(law, sizes, values, dimension));
    std::stable_sort(all.begin(), all.end(),
                     [](const Fit& f, const Fit& g) { return f.residual < g.residual; });
    return all;
}

}  // namespace hedgerow::measure
