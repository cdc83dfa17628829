/// The columns of each question: the numbers of a row that is asked, and those of a row that answers. With
/// them every question of the table (questions.h) reads its queries from files and writes its answers to
/// files, as `hedgerow query` does.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <hedgerow/base/column.h>
#include <hedgerow/questions.h>

namespace hedgerow {

/// What is given to a question beside its rows, the same for all of them.
struct RowOptions {
    /// How many neighbours or hits to find, at least 1.
    std::size_t count = 0;
    /// Not squared, at least 0; infinite for no limit.
    double radius = std::numeric_limits<double>::infinity();
    /// How many times as far away as the exact answer an answer may be, at least 1 (PointOptions).
    double factor = 1;
    /// Of what is asked of a solid: how it is made.
    SolidOptions solid = {};

    /// The options of a question of a point. The radius is rounded to T.
    template <std::floating_point T>
    PointOptions near() const {
        return {.radius = static_cast<double>(rounded_to<T>(radius)), .factor = factor};
    }
};

namespace detail {

/// "x", "y", "z" with something before: {"ox", "oy", "oz"}.
template <int D>
void add_axes(std::vector<std::string>& names, const std::string& before) {
    for (int k = 0; k < D; ++k) names.push_back(before + "xyz"[k]);
}
template <int D, class T>
Vec<T, D> vec_at(const T* numbers) {
    Vec<T, D> v;
    for (int k = 0; k < D; ++k) v[k] = numbers[k];
    return v;
}
/// Whether all numbers are finite, and no larger than `most`.
template <class T>
bool all_finite(const T* numbers, int count, T most = std::numeric_limits<T>::max()) {
    for (int k = 0; k < count; ++k)
        if (!(std::abs(numbers[k]) <= most)) return false;
    return true;
}
/// Whether the coordinates of a place are such that distances from it and to it are finite.
template <int D, class T>
bool is_place(const T* numbers) {
    return all_finite(numbers, D, largest_coordinate<T>);
}

/// The rows of questions about a point.
template <std::floating_point T, int D>
struct PointRows {
    static InputColumns columns() {
        InputColumns all;
        add_axes<D>(all.names, "");
        return all;
    }
    static bool usable(const T* row) { return is_place<D>(row); }
};

}  // namespace detail

/// How a row of numbers becomes what is given to a question. `columns` says which numbers a row has; `usable`
/// whether they are such that there can be an answer (none is NaN, and places are finite and within
/// `largest_coordinate`); `of` makes the query. `needs_count` and `needs_radius` say which options it cannot
/// do without.
template <class Given>
struct RowsOf;

template <std::floating_point T, int D>
struct RowsOf<Ray<T, D>> {
    static constexpr bool needs_count = false, needs_radius = false;
    /// An origin, a direction, and an interval that may be left out.
    static InputColumns columns() {
        InputColumns all;
        detail::add_axes<D>(all.names, "o");
        detail::add_axes<D>(all.names, "d");
        all.names.insert(all.names.end(), {"t_min", "t_max"});
        all.defaults = {0, std::numeric_limits<double>::infinity()};
        return all;
    }
    static bool usable(const T* row) {
        return detail::is_place<D>(row) && detail::all_finite(row + D, D + 1) && !std::isnan(row[2 * D + 1]);
    }
    static Ray<T, D> of(const T* row, const RowOptions&) {
        return {detail::vec_at<D>(row), detail::vec_at<D>(row + D), row[2 * D], row[2 * D + 1]};
    }
};
/// A ray, of which the first hits are asked.
template <std::floating_point T, int D>
struct RowsOf<HitsAlong<T, D>> : RowsOf<Ray<T, D>> {
    static constexpr bool needs_count = true;
    static HitsAlong<T, D> of(const T* row, const RowOptions& o) {
        return {RowsOf<Ray<T, D>>::of(row, o), o.count};
    }
};
template <std::floating_point T, int D>
struct RowsOf<Vec<T, D>> : detail::PointRows<T, D> {
    static constexpr bool needs_count = false, needs_radius = false;
    static Vec<T, D> of(const T* row, const RowOptions&) { return detail::vec_at<D>(row); }
};
template <std::floating_point T, int D>
struct RowsOf<Neighbours<T, D>> : detail::PointRows<T, D> {
    static constexpr bool needs_count = true, needs_radius = false;
    static Neighbours<T, D> of(const T* row, const RowOptions& o) {
        return {detail::vec_at<D>(row), o.count, o.near<T>()};
    }
};
template <std::floating_point T, int D>
struct RowsOf<Ball<T, D>> : detail::PointRows<T, D> {
    static constexpr bool needs_count = false, needs_radius = true;
    static Ball<T, D> of(const T* row, const RowOptions& o) {
        return {detail::vec_at<D>(row), NearLimits<T>(o.near<T>()).distance2};
    }
};
/// A solid ball, as a region.
template <std::floating_point T, int D>
struct RowsOf<Sphere<T, D>> : detail::PointRows<T, D> {
    static constexpr bool needs_count = false, needs_radius = true;
    static Sphere<T, D> of(const T* row, const RowOptions& o) {
        return {detail::vec_at<D>(row), rounded_to<T>(o.radius)};
    }
};
template <std::floating_point T, int D>
struct RowsOf<Box<T, D>> {
    static constexpr bool needs_count = false, needs_radius = false;
    /// Both corners. They may be infinite; a box whose low corner is not below its high one is empty.
    static InputColumns columns() {
        InputColumns all;
        detail::add_axes<D>(all.names, "low_");
        detail::add_axes<D>(all.names, "high_");
        return all;
    }
    static bool usable(const T* row) {
        for (int k = 0; k < 2 * D; ++k)
            if (std::isnan(row[k])) return false;
        return true;
    }
    static Box<T, D> of(const T* row, const RowOptions&) {
        return {detail::vec_at<D>(row), detail::vec_at<D>(row + D)};
    }
};

/// Questions of points that take PointOptions beside the points of a batch.
template <class Question, class T, int D>
concept TakesPointOptions = requires(const AnyIndex<T, D>& index, std::span<const Vec<T, D>> given,
                                     std::span<typename Question::Answer> found) {
    Question::ask_all(index, given, found, {}, PointOptions());
};

/// Lists the options that a question of rows takes (base/option.h), of which it needs the first where its
/// RowsOf says so.
template <class Question, std::floating_point T, int D, class Option>
void list_row_options(RowOptions& o, Option& option) {
    using Given = typename Question::Given;
    using Rows = RowsOf<Given>;
    constexpr double any = std::numeric_limits<double>::infinity();
    constexpr bool near = TakesPointOptions<Question, T, D> || std::same_as<Given, Neighbours<T, D>>;
    if constexpr (Rows::needs_count)
        option("count", o.count, 1, std::numeric_limits<std::size_t>::max(), "how many to find, at least 1");
    if constexpr (Rows::needs_radius || near)
        option("radius", o.radius, 0, any,
               Rows::needs_radius ? "a distance, at least 0" : "nothing is found beyond this distance");
    if constexpr (near)
        option("factor", o.factor, 1, any,
               Question::name == "farthest-point"
                   ? "how many times less far away than the exact answer one may be"
                   : "how many times as far away as the exact answer one may be");
    if constexpr (AsksSolid<Question>) {
        // Some are told by some of the ways alone, whose names are those of SideBy.
        std::span<const std::string_view> ways = side_by_names;
        if constexpr (requires { Question::ways; }) ways = Question::ways;
        option("by", o.solid.by, ways, "how insides are told");
        option("error", o.solid.error, 1e-9, 1, "how far winding numbers by expansion may be off");
    }
}

/// Calls f(name, number) for each column of an answer.
template <std::floating_point T, class F>
void list_columns(const Hit<T>& hit, F& f) {
    f("primitive", hit.primitive), f("t", hit.t), f("u", hit.u), f("v", hit.v);
}
/// The distance, which is not squared here.
template <std::floating_point T, int D>
T distance_of(const Near<T, D>& near) {
    return rounded_to<T>(std::sqrt(static_cast<double>(near.distance2)));
}
template <std::floating_point T, int D, class F>
void list_columns(const Near<T, D>& near, F& f) {
    constexpr std::string_view axes[] = {"x", "y", "z"};
    f("primitive", near.primitive), f("distance", distance_of(near));
    for (int k = 0; k < D; ++k) f(axes[k], near.point[k]);
}

/// The feature is 0 for a face, 1 for an edge, 2 for a vertex, and -128 where nothing was found. The weights
/// are those of the corners in their order.
template <std::floating_point T, int D, class F>
void list_columns(const NearAndFeature<T, D>& answer, F& f) {
    constexpr std::string_view weights[] = {"weight_a", "weight_b", "weight_c"}, axes[] = {"nx", "ny", "nz"};
    constexpr std::int8_t none = std::numeric_limits<std::int8_t>::min();
    const auto& [near, where] = answer;
    list_columns(near, f);
    f("feature", near ? static_cast<std::int8_t>(where.feature) : none);
    f("number", near ? static_cast<std::int8_t>(where.number) : none);
    for (std::size_t k = 0; k < D; ++k) f(weights[k], where.weights[k]);
    for (int k = 0; k < D; ++k) f(axes[k], where.normal[k]);
}

/// The answer to a row that can have none: what stands for nothing found, NaN for a number that every
/// point has, and -128 for a sign.
template <class Question>
typename Question::Answer no_answer() {
    if constexpr (std::is_floating_point_v<typename Question::Answer>)
        return std::numeric_limits<typename Question::Answer>::quiet_NaN();
    else if constexpr (std::is_same_v<typename Question::Answer, std::int8_t>)
        return std::numeric_limits<std::int8_t>::min();
    else
        return {};
}

/// Calls f(name, number) for each column of an answer to a question. An answer that is a number or a truth
/// value has the question's `column`.
template <class Question, class F>
void list_answer(const typename Question::Answer& answer, F& f) {
    if constexpr (std::is_arithmetic_v<typename Question::Answer>)
        f(Question::column, answer);
    else
        list_columns(answer, f);
}

/// Calls f(name, number) for each column of an element of a list, which follow the number of its query. A
/// position in the set becomes the id that the index reports for it.
template <class I, std::floating_point T, class F>
void list_item_columns(const I&, const Hit<T>& hit, F& f) {
    list_columns(hit, f);
}
template <class I, std::floating_point T, int D, class F>
void list_item_columns(const I&, const Near<T, D>& near, F& f) {
    f("primitive", near.primitive), f("distance", distance_of(near));
}
template <class I, class F>
void list_item_columns(const I& index, PrimitiveId element, F& f) {
    f("primitive", index.id(element));
}

}  // namespace hedgerow
