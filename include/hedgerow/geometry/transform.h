/// Affine maps of space, with their inverses.
#pragma once

#include <initializer_list>

#include <hedgerow/base/error.h>
#include <hedgerow/geometry/box.h>
#include <hedgerow/geometry/eigen.h>
#include <hedgerow/geometry/shapes.h>

namespace hedgerow {

/// An affine map, without its inverse: x ↦ linear·x + shift.
template <int D>
struct Affine {
    Rows<D> linear{};
    Vec<double, D> shift;

    Vec<double, D> vector(const Vec<double, D>& v) const {
        Vec<double, D> r;
        for (int k = 0; k < D; ++k) r[k] = dot(linear[static_cast<std::size_t>(k)], v);
        return r;
    }
    Vec<double, D> point(const Vec<double, D>& p) const { return vector(p) + shift; }
    /// The bounds of the image of a box (Arvo 1990). The sums are those of `point` in the same order, and
    /// rounding is monotone. So the computed image of a point in the box is in the computed bounds.
    Box<double, D> box(const Box<double, D>& b) const {
        Box<double, D> r{Vec<double, D>(), Vec<double, D>()};
        for (int k = 0; k < D; ++k) {
            const auto& row = linear[static_cast<std::size_t>(k)];
            for (int j = 0; j < D; ++j) {
                const double x = product(row[j], b.low[j]), y = product(row[j], b.high[j]);
                r.low[k] += std::min(x, y), r.high[k] += std::max(x, y);
            }
            r.low[k] += shift[k], r.high[k] += shift[k];
        }
        return r;
    }
    /// The largest factor by which a vector's largest component may grow.
    double reach() const {
        double most = 0;
        for (const auto& row : linear) {
            double sum = 0;
            for (int k = 0; k < D; ++k) sum += std::abs(row[k]);
            most = std::max(most, sum);
        }
        return most;
    }
    /// The singular values: how much vectors are stretched along the axes of an ellipsoid.
    Vec<double, D> stretches() const {
        Rows<D> squared{};
        const double unit = reach() > 0 ? 1 / reach() : 0;
        for (std::size_t i = 0; i < squared.size(); ++i)
            for (std::size_t j = 0; j < squared.size(); ++j)
                for (const auto& row : linear)
                    squared[i][static_cast<int>(j)] +=
                        product(row[static_cast<int>(i)] * unit, row[static_cast<int>(j)] * unit);
        return map(eigen_of_symmetric(squared).values,
                   [&](double x) { return std::sqrt(std::max(0.0, x)) / unit; });
    }
    bool operator==(const Affine&) const = default;
};

/// An affine map and its inverse, in double. The inverse is computed once, by the constructor.
template <int D>
class Transform {
public:
    using Vector = Vec<double, D>;

    /// The identity.
    Transform() : Transform(identity(), Vector()) {}
    /// The map with the given rows of its linear part, which maps 0 to `shift`. Throws InputError if an entry
    /// is NaN or infinite, or if the map is singular or so nearly singular that its inverse would not undo it
    /// to one part in a million.
    Transform(const Rows<D>& linear, const Vector& shift) : there_{linear, shift} { invert(); }

    static Transform translation(const Vector& by) { return {identity(), by}; }
    static Transform scaling(const Vector& by) {
        Rows<D> m{};
        for (int k = 0; k < D; ++k) m[static_cast<std::size_t>(k)][k] = by[k];
        return {m, Vector()};
    }
    static Transform scaling(double by) { return scaling(Vector::all(by)); }
    /// A counterclockwise rotation, by an angle in radians.
    static Transform rotation(double angle) requires(D == 2) {
        const double c = std::cos(angle), s = std::sin(angle);
        return {{Vector(c, -s), Vector(s, c)}, Vector()};
    }
    /// A rotation about an axis of any length but 0, by an angle in radians, counterclockwise seen from the
    /// tip of the axis (Rodrigues 1840).
    static Transform rotation(const Vector& axis, double angle) requires(D == 3) {
        const Vector a = normalized(axis);
        const double c = std::cos(angle), s = std::sin(angle);
        Rows<3> m{};
        for (int k = 0; k < 3; ++k) {
            const int i = (k + 1) % 3, j = (k + 2) % 3;
            Vector& row = m[static_cast<std::size_t>(k)];
            row[k] = c + a[k] * a[k] * (1 - c);
            row[i] = a[k] * a[i] * (1 - c) - s * a[j];
            row[j] = a[k] * a[j] * (1 - c) + s * a[i];
        }
        return {m, Vector()};
    }

    const Affine<D>& there() const { return there_; }
    const Affine<D>& back() const { return back_; }
    /// A bound of |there·back − 1|: the error of mapping there and back, relative to the distances involved.
    double residual() const { return residual_; }

    /// The map that applies b first, then a.
    friend Transform operator*(const Transform& a, const Transform& b) {
        Rows<D> m{};
        for (std::size_t i = 0; i < m.size(); ++i)
            for (std::size_t j = 0; j < m.size(); ++j)
                m[i] = m[i] + b.there_.linear[j] * a.there_.linear[i][static_cast<int>(j)];
        return {m, a.there_.point(b.there_.shift)};
    }
    friend bool operator==(const Transform&, const Transform&) = default;

private:
    static Rows<D> identity() {
        Rows<D> m{};
        for (int k = 0; k < D; ++k) m[static_cast<std::size_t>(k)][k] = 1;
        return m;
    }
    /// Computes the inverse by Gauss-Jordan elimination, with the largest pivot of each column, and the
    /// residual.
    void invert() {
        Rows<D> m = there_.linear, inverse = identity();
        // A map with an entry that is not finite is rejected below, as a singular one is.
        bool good = finite(there_.shift);
        for (const auto& row : m) good = good && finite(row);
        for (int k = 0; k < D && good; ++k) {
            const auto at = static_cast<std::size_t>(k);
            // Bring the row with the largest pivot up, and scale the pivot to 1.
            std::size_t pivot = at;
            for (std::size_t i = at; i < m.size(); ++i)
                if (std::abs(m[i][k]) > std::abs(m[pivot][k])) pivot = i;
            if (m[pivot][k] == 0) good = false;
            if (!good) break;
            std::swap(m[at], m[pivot]);
            std::swap(inverse[at], inverse[pivot]);
            inverse[at] = inverse[at] / m[at][k];
            m[at] = m[at] / m[at][k];
            // Clear the column in all other rows.
            for (std::size_t i = 0; i < m.size(); ++i) {
                if (i == at) continue;
                const double by = m[i][k];
                inverse[i] = inverse[i] - inverse[at] * by;
                m[i] = m[i] - m[at] * by;
            }
        }
        back_ = {inverse, Vector()};
        back_.shift = -back_.vector(there_.shift);
        // Bound |there·back − 1| by the sum of all its entries, with the rounding errors of each.
        residual_ = good ? 0 : 1;
        for (std::size_t i = 0; i < m.size() && good; ++i)
            for (std::size_t j = 0; j < m.size(); ++j) {
                double x = i == j ? -1 : 0, size = 0;
                for (std::size_t k = 0; k < m.size(); ++k) {
                    const double part =
                        product(there_.linear[i][static_cast<int>(k)], inverse[k][static_cast<int>(j)]);
                    x += part, size += std::abs(part);
                }
                residual_ += std::abs(x) + 16 * unit_roundoff<double> * size;
            }
        if (!(residual_ < 1e-6) || !finite(back_.shift))
            throw InputError(
                "a transform is singular, nearly singular or not finite: it has to be invertible, "
                "so scale by nothing that is 0 or as good as 0 beside the rest");
    }

    Affine<D> there_, back_;
    double residual_ = 0;
};

/// Images of points and shapes under an affine map. The corners are rounded to T.
template <class T, int D>
Vec<T, D> transformed(const Affine<D>& f, const Vec<T, D>& p) {
    return Vec<T, D>(f.point(Vec<double, D>(p)));
}
template <class T, int D>
Triangle<T, D> transformed(const Affine<D>& f, const Triangle<T, D>& t) {
    return {transformed(f, t.a), transformed(f, t.b), transformed(f, t.c)};
}
template <class T, int D>
Segment<T, D> transformed(const Affine<D>& f, const Segment<T, D>& s) {
    return {transformed(f, s.a), transformed(f, s.b)};
}

}  // namespace hedgerow
