/// The winding number of points with normals: a surface of which only samples are known.
#pragma once

#include <string>

#include <hedgerow/ask/insides.h>

namespace hedgerow {

/// Points in space with normals as a surface (Barill et al. 2018). The length of a normal is the area that
/// its point is a sample of. The winding number about x is the sum of n·(p − x)/(4π|p − x|³): about 1 inside
/// of what the samples cover, about 0 outside, and anything nearer to a point than its neighbours are. A
/// point at x adds nothing.
///
/// The sum is expanded as that of a Solid by expansion is, and errs by at most `error`, beyond roundings of
/// double. Made once of an index of points, in O(n log n); its questions are thread-safe and allocate
/// nothing, but for memory that threads keep. The index and the normals, one for each point of the set by its
/// id, must outlive it.
template <class I>
class OrientedPoints {
public:
    using Scalar = typename I::Scalar;
    static constexpr int dimension = 3;
    using Point = Vec<Scalar, 3>;
    static_assert(I::dimension == 3 && PointSet<typename I::Primitives>,
                  "an index of points in space is expected");

    /// Throws InputError if there are not as many normals as points or one is not finite, or if the index
    /// lacks points of its set; UsageError for an error that cannot be promised.
    OrientedPoints(const I& index, const Strided<Point>& normals, double error = SolidOptions().error,
                   Threads threads = {})
        : index_(&index), normals_(normals), error_(error) {
        detail::expect_possible_error(error);
        in_ieee_mode([&] {
            expect_normals();
            detail::expect_all_held(index);
            IeeeExecutor executor(threads.over(index.size()));
            expansion_.emplace(
                index, [this](double scale) { return parts(scale); }, executor);
        });
    }
    OrientedPoints(I&&, const Strided<Point>&, double = 0, Threads = {}) = delete;

    // What the functions of ask/insides.h ask.

    template <class Count>
    double tell_winding_number(const Point& point, Count& count) const {
        if (!finite(point)) return std::numeric_limits<double>::quiet_NaN();
        return in_ieee_mode([&] {
            return expansion_->winding_number(parts(expansion_->scale()), Vec3d(point), error_, count);
        });
    }
    /// Inside where the winding number is at least one half, else outside.
    template <class Count>
    Side tell_side(const Point& point, Count& count) const {
        return tell_winding_number(point, count) >= 0.5 ? Side::inside : Side::outside;
    }
    void write_winding_numbers(const PointBatch<Scalar, 3>& points, std::span<double> numbers) const {
        for (std::size_t i = 0; i < points.size(); ++i)
            numbers[points.number(i)] = tell_winding_number(points[i], no_visits);
    }
    void write_sides(const PointBatch<Scalar, 3>& points, std::span<Side> sides) const {
        for (std::size_t i = 0; i < points.size(); ++i)
            sides[points.number(i)] = tell_side(points[i], no_visits);
    }

    const I& index() const { return *index_; }
    const Box<Scalar, 3>& bounds() const { return index_->bounds(); }
    double error() const { return error_; }
    std::size_t bytes_of_index() const { return index_->bytes(); }
    /// Bytes beyond the index and the normals.
    std::size_t bytes() const { return expansion_->bytes(); }

private:
    using Parts = WindingDipoles<typename I::Primitives>;

    Parts parts(double scale) const { return Parts(index_->primitives(), normals_, scale); }
    void expect_normals() const {
        if (normals_.size() != index_->size())
            throw InputError("points and normals must be as many, but there are " +
                             std::to_string(index_->size()) + " points and " +
                             std::to_string(normals_.size()) + " normals");
        for (std::size_t i = 0; i < normals_.size(); ++i)
            if (!finite(normals_[i])) throw InputError("normal " + std::to_string(i) + " is not finite");
    }

    const I* index_;
    Strided<Point> normals_;
    double error_;
    std::optional<detail::ExpandedIndex<I, Parts>> expansion_;
};

}  // namespace hedgerow
