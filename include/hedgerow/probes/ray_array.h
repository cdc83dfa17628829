/// A view of a batch of rays in the caller's arrays.
#pragma once

#include <array>
#include <string>

#include <hedgerow/base/error.h>
#include <hedgerow/base/strided.h>
#include <hedgerow/geometry/ray.h>

namespace hedgerow {

/// A view of rays in the caller's arrays, whatever their layout: whole rays, origins and directions apart, or
/// an array for each component. Copies nothing, owns nothing; no address need be aligned.
///
///   closest_hits(index, rays, hits);                                   // a vector or span of Ray3f
///   closest_hits(index, RayArray<float, 3>(origins, directions), hits);
///   closest_hits(index, RayArray<float, 3>({ox, oy, oz}, {dx, dy, dz}, {}, t_max), hits);
///
/// Kernels read rays in place if each ray's numbers are contiguous in Ray's order (the rays may be at any
/// distance from each other). Other rays are gathered first, which costs a batch some nanoseconds a ray.
template <std::floating_point T, int D>
class RayArray {
public:
    using RayType = Ray<T, D>;
    /// An array for each component.
    using Components = std::array<Strided<T>, static_cast<std::size_t>(D)>;
    /// Numbers of a ray: origin, direction, t_min and t_max.
    static constexpr std::size_t words = 2 * D + 2;
    static_assert(sizeof(RayType) == words * sizeof(T));

    RayArray() = default;
    /// A view of whole rays: a span, a vector or an array of them.
    template <class R>
    requires std::convertible_to<const R&, std::span<const RayType>> RayArray(const R& rays)
        : RayArray(Strided<RayType>(std::span<const RayType>(rays))) {}
    /// A view of `size` contiguous rays.
    RayArray(const RayType* first, std::size_t size) : RayArray(Strided<RayType>(first, size)) {}
    RayArray(Strided<RayType> rays) : size_(rays.size()), together_(true) {
        for (std::size_t w = 0; w < words; ++w) columns_[w] = {place(rays, w), rays.stride()};
    }
    /// A view of rays by origins and directions. t_min is 0 and t_max infinite if their array is empty.
    /// Throws InputError for arrays of different lengths.
    RayArray(Strided<Vec<T, D>> origins, Strided<Vec<T, D>> directions, Strided<T> t_min = {},
             Strided<T> t_max = {})
        : size_(origins.size()) {
        expect_length("directions", directions.size());
        for (std::size_t k = 0; k < D; ++k) {
            columns_[k] = {place(origins, k), origins.stride()};
            columns_[D + k] = {place(directions, k), directions.stride()};
        }
        set_interval(t_min, t_max);
    }
    /// A view of rays by the components of origins and directions. t_min is 0 and t_max infinite if their
    /// array is empty. Throws InputError for arrays of different lengths.
    RayArray(const Components& origins, const Components& directions, Strided<T> t_min = {},
             Strided<T> t_max = {})
        : size_(origins[0].size()) {
        static constexpr const char* names[] = {"x", "y", "z"};
        for (std::size_t k = 0; k < D; ++k) {
            expect_length(std::string(names[k]) + " of origins", origins[k].size());
            expect_length(std::string(names[k]) + " of directions", directions[k].size());
        }
        for (std::size_t k = 0; k < D; ++k) {
            columns_[k] = {origins[k].at(0), origins[k].stride()};
            columns_[D + k] = {directions[k].at(0), directions[k].stride()};
        }
        set_interval(t_min, t_max);
    }

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    RayType operator[](std::size_t i) const {
        RayType ray;
        for (int k = 0; k < D; ++k) {
            ray.origin[k] = word(i, static_cast<std::size_t>(k));
            ray.direction[k] = word(i, static_cast<std::size_t>(D + k));
        }
        ray.t_min = word(i, 2 * D), ray.t_max = word(i, 2 * D + 1);
        return ray;
    }
    /// Rays `first` to `first + count − 1`.
    RayArray part(std::size_t first, std::size_t count) const {
        assert(first + count <= size_);
        RayArray some = *this;
        some.size_ = count;
        for (Column& c : some.columns_)
            if (count > 0) c.data += first * c.stride;
        return some;
    }

    /// Whether the numbers of each ray are contiguous, in Ray's order.
    bool together() const { return together_; }
    /// The address of number w of ray i, which need not be aligned.
    const std::byte* at(std::size_t i, std::size_t w = 0) const {
        return columns_[w].data + i * columns_[w].stride;
    }
    /// The distance in bytes from number w of a ray to that of the next.
    std::size_t stride(std::size_t w = 0) const { return columns_[w].stride; }
    T word(std::size_t i, std::size_t w) const {
        assert(i < size_);
        T value;
        std::memcpy(&value, at(i, w), sizeof(T));
        return value;
    }

private:
    struct Column {
        const std::byte* data = nullptr;
        std::size_t stride = 0;
    };
    static constexpr T from_the_start = RayType{}.t_min, without_end = RayType{}.t_max;

    /// The address of number w of the first element. Null for an empty array.
    template <class E>
    static const std::byte* place(const Strided<E>& all, std::size_t w) {
        return all.empty() ? nullptr : all.at(0) + w * sizeof(T);
    }
    void expect_length(const std::string& of, std::size_t count) const {
        if (count != size_)
            throw InputError("there are " + std::to_string(size_) + " origins of rays, but " +
                             std::to_string(count) + " " + of + ": make the arrays as long as each other");
    }
    void set_interval(const Strided<T>& t_min, const Strided<T>& t_max) {
        const auto set = [&](const char* name, const Strided<T>& all, const T& standard, Column& column) {
            if (!all.empty()) expect_length(name, all.size());
            column = all.empty() ? Column{reinterpret_cast<const std::byte*>(&standard), 0}
                                 : Column{all.at(0), all.stride()};
        };
        set("t_min", t_min, from_the_start, columns_[2 * D]);
        set("t_max", t_max, without_end, columns_[2 * D + 1]);
        together_ = size_ > 0;
        for (std::size_t w = 1; w < words; ++w)
            together_ = together_ && columns_[w].data == columns_[0].data + w * sizeof(T) &&
                        columns_[w].stride == columns_[0].stride;
    }

    std::array<Column, words> columns_{};
    std::size_t size_ = 0;
    bool together_ = false;
};

}  // namespace hedgerow
