/// Any structure behind one type, chosen at run time by its name and options. What the tool and the tests
/// link.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <hedgerow/ask.h>
#include <hedgerow/primitives/point_cloud.h>
#include <hedgerow/primitives/segment_set.h>
#include <hedgerow/primitives/sphere_set.h>
#include <hedgerow/trace.h>

namespace hedgerow {

/// One virtual call a batch; inside it everything is as if the structure were known. Const use is
/// thread-safe.
template <std::floating_point T, int D>
class AnyIndex {
public:
    virtual ~AnyIndex() = default;

    /// As it was asked for, and in full with every option.
    virtual std::string_view structure() const = 0;
    virtual const Box<T, D>& bounds() const = 0;
    virtual std::size_t size() const = 0;
    /// Beyond the primitives themselves.
    virtual std::size_t bytes() const = 0;
    virtual std::size_t node_count() const = 0;
    virtual std::size_t leaf_count() const = 0;
    virtual std::size_t item_count() const = 0;
    virtual int depth() const = 0;
    /// What is wrong with the structure; empty if nothing is.
    virtual std::string validate() const = 0;

    /// One hit a ray (false where nothing is hit), by what the call returns. With `visits`, one count a ray
    /// is added to, and no kernel answers.
    virtual KernelUse closest_hits(const RayArray<T, D>& rays, std::span<Hit<T>> hits,
                                   std::span<Visits> visits = {}) const = 0;
    virtual KernelUse any_hits(const RayArray<T, D>& rays, std::span<bool> hits,
                               std::span<Visits> visits = {}) const = 0;
    virtual std::size_t all_hits(const Ray<T, D>& ray, std::vector<Hit<T>>& hits,
                                 Visits* visits = nullptr) const = 0;
    /// One a point; element none where there is no primitive.
    virtual void closest_points(std::span<const Vec<T, D>> points, std::span<Near<T, D>> found,
                                std::span<Visits> visits = {}) const = 0;
    virtual std::size_t nearest(const Vec<T, D>& point, std::size_t k, std::vector<Near<T, D>>& found,
                                Visits* visits = nullptr) const = 0;
    virtual std::size_t overlapping(const Box<T, D>& box, std::vector<PrimitiveId>& found,
                                    Visits* visits = nullptr) const = 0;

    /// Its cells, parents before their children (structures/outline.h).
    virtual std::vector<OutlineCell<D>> outline(const OutlineLimits<D>& limits = {}) const = 0;
    /// What `closest_hits` does with a ray, step by step (trace.h).
    virtual Trace<T, D> trace(const Ray<T, D>& ray) const = 0;
    /// Whether primitives can be inserted and erased, and whether it can be fitted to ones that moved. What
    /// can do neither is built again, and throws InputError when asked.
    virtual bool changes_one_by_one() const = 0;
    virtual bool refittable() const = 0;
    /// As the functions of Index, for the borrowed primitives where they lie.
    virtual bool insert(PrimitiveId id) = 0;
    virtual bool erase(PrimitiveId id) = 0;
    virtual double refit(Executor& executor = serial_executor()) = 0;
};

/// An option of a structure, for help and for messages.
struct OptionInfo {
    std::string_view name, values, standard, meaning;
};
struct StructureInfo {
    std::string_view name, description;
    std::vector<OptionInfo> options;
    /// Of the only sets that it holds; 0: of any.
    int dimension = 0;
    bool points_only = false;

    /// Whether it can be built over sets of a dimension, of points or of something else.
    bool holds(int set_dimension, bool points) const {
        return (dimension == 0 || dimension == set_dimension) && (points || !points_only);
    }
};
/// Every structure that `build_any` knows.
const std::vector<StructureInfo>& structure_list();

namespace detail {
template <class View>
std::unique_ptr<AnyIndex<typename View::Scalar, View::dimension>> build_any_over(std::string_view spec,
                                                                                 const View& primitives,
                                                                                 Executor& executor);
}

/// Builds what `spec` names over primitives that are borrowed: "bvh", "bvh:builder=sweep,max_leaf_size=4".
/// Throws UsageError for unknown names and options (with the nearest that exists), and InputError for bad
/// primitives.
/// Defined for TriangleMesh<T>, SphereSet<T, 3>, PointCloud<T, 2 or 3> and SegmentSet<T> and for views of
/// such in arrays of the caller's, T float or double.
template <class P>
auto build_any(std::string_view spec, const P& primitives, Executor& executor = default_executor()) {
    return detail::build_any_over(spec, view_of(primitives), executor);
}
/// The same of an index that is there already: one of triangles in a WideBvh, built or loaded
/// (io/index_file.h). T is float or double.
template <std::floating_point T>
std::unique_ptr<AnyIndex<T, 3>> any_index(Index<WideBvh<T, 3>, TriangleMeshView<T>> index);

}  // namespace hedgerow
