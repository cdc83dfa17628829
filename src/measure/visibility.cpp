#include <hedgerow/measure/visibility.h>

#include <memory>

#include <hedgerow/any_index.h>
#include <hedgerow/base/error.h>
#include <hedgerow/measure/contest.h>
#include <hedgerow/measure/costs.h>
#include <hedgerow/mesh_index.h>
#include <hedgerow/render/camera/ray_maker.h>
#include <hedgerow/render/visibility/beams.h>
#include <hedgerow/render/visibility/rasterise.h>

namespace hedgerow::measure {

namespace {

template <class T>
class MeasuringVisibility {
public:
    MeasuringVisibility(const TriangleMesh<T>& mesh, const VisibilityOptions& o, const Progress& progress)
        : mesh_(mesh),
          o_(o),
          progress_(progress),
          samples_(o.camera, o.width, o.height),
          rays_(samples_.rays()),
          hits_(rays_.size()) {}

    VisibilityCase run() {
        VisibilityCase result{mesh_.size(), o_.width, o_.height, 0, {}, {}};
        steps_ = static_cast<std::uint64_t>(o_.rounds + 1) * (o_.structures.size() + 4);
        // Set up each way, and count what it does. The first way's hits are the reference.
        for (const std::string& structure : o_.structures) {
            add_casting(structure);
            step();
        }
        if constexpr (std::same_as<T, float>) add_beams();
        step();
        const bool few = mesh_.size() * samples_.size() <= o_.most_tests;
        if (!few) result.left_out.push_back("raster:all");
        if (few) add_rasterising("raster:all", Coverage::all), step();
        add_rasterising("raster:box", Coverage::box), step();
        add_rasterising("raster:tiles", Coverage::tiles), step();
        for (const auto& hit : reference_) result.hit += bool(hit);
        result.hit /= double(std::max<std::size_t>(1, reference_.size()));
        // Time all ways in turn.
        const auto times = measured_in_turn(o_.rounds, contest_, Clock::thread, [&](const std::string&) {
            step();
            return true;
        });
        for (std::size_t i = 0; i < times.size(); ++i)
            costs_[i].seconds = times[i].median, costs_[i].spread = times[i].spread;
        result.ways = std::move(costs_);
        return result;
    }

private:
    void step() {
        progress_.look();
        progress_(++done_, steps_);
    }
    void check(const std::string& way) {
        if (reference_.empty()) reference_ = hits_;
        if (hits_ != reference_)
            throw Disagreement(way + " finds other hits than " + costs_.front().way +
                               ". This is a fault of the library: please report the scene");
    }

    void add_casting(const std::string& structure) {
        VisibilityCost cost;
        cost.way = "cast:" + structure;
        std::vector<double> builds;
        std::shared_ptr<const AnyIndex<T, 3>> index;
        for (int k = 0; k < std::min(3, o_.rounds); ++k)
            builds.push_back(seconds_of([&] { index = build_any(structure, mesh_, serial_executor()); }));
        if (builds.empty()) index = build_any(structure, mesh_, serial_executor());
        cost.build_seconds = builds.empty() ? 0 : median(builds);
        cost.bytes = index->bytes();
        std::vector<Visits> visits(rays_.size());
        closest_hits(*index, rays_, hits_, {.threads = serial_executor()}, KeepAll(), visits);
        Visits all;
        for (const Visits& v : visits) all += v;
        cost.tests = a_sample(all.primitives), cost.nodes = a_sample(all.nodes + all.leaves);
        check(cost.way);
        contest_.add(cost.way, [this, index] {
            closest_hits(*index, rays_, hits_, {.threads = serial_executor()});
            return hits_.size();
        });
        costs_.push_back(cost);
    }
    void add_beams() {
        VisibilityCost cost;
        cost.way = "beams:wide";
        std::vector<double> builds;
        std::shared_ptr<const MeshIndex<T>> index;
        for (int k = 0; k < std::clamp(o_.rounds, 1, 3); ++k)
            builds.push_back(seconds_of([&] {
                index = std::make_shared<const MeshIndex<T>>(build<WideBvh>(mesh_, serial_executor()));
            }));
        cost.build_seconds = median(builds), cost.bytes = index->bytes();
        const auto trace = [this, index] {
            return beam_hits(*index, samples_, hits_, {.threads = serial_executor()});
        };
        cost.nodes = a_sample(trace().visits);
        check(cost.way);
        contest_.add(cost.way, [trace] { return trace().visits; });
        costs_.push_back(cost);
    }
    void add_rasterising(const std::string& way, Coverage coverage) {
        const auto rasteriser = std::make_shared<Rasteriser<T>>(samples_);
        const auto draw = [this, rasteriser, coverage](bool counts) {
            return rasteriser->draw(mesh_.view(), hits_,
                                    {.coverage = coverage, .counts = counts, .threads = serial_executor()});
        };
        VisibilityCost cost;
        cost.way = way;
        cost.tests = a_sample(draw(true).tests);
        check(cost.way);
        cost.bytes = rasteriser->bytes();
        contest_.add(way, [draw] { return draw(false).triangles; });
        costs_.push_back(cost);
    }
    double a_sample(std::uint64_t count) const {
        return double(count) / double(std::max<std::size_t>(1, samples_.size()));
    }

    const TriangleMesh<T>& mesh_;
    const VisibilityOptions& o_;
    const Progress& progress_;
    const PictureSamples<T> samples_;
    const std::vector<Ray<T, 3>> rays_;
    std::vector<Hit<T>> hits_, reference_;
    Contest contest_;
    std::vector<VisibilityCost> costs_;
    std::uint64_t done_ = 0, steps_ = 0;
};

}  // namespace

template <class T>
VisibilityCase compare_visibility(const TriangleMesh<T>& mesh, const VisibilityOptions& options,
                                  const Progress& progress) {
    check_camera(options.camera);
    return MeasuringVisibility<T>(mesh, options, progress).run();
}
template VisibilityCase compare_visibility(const TriangleMesh<float>&, const VisibilityOptions&,
                                           const Progress&);
template VisibilityCase compare_visibility(const TriangleMesh<double>&, const VisibilityOptions&,
                                           const Progress&);

}  // namespace hedgerow::measure
