/// Rounds of the hunter over pairs: of two sets and of one, of triangles and of points.
#include "pairs.h"

#include <sstream>

#include "report.h"
#include "scenes.h"
#include "shrink.h"

namespace hedgerow::hunter {

namespace {

template <class Shape>
class HuntPairs {
public:
    HuntPairs(std::uint64_t seed, std::uint64_t round) : seed_(seed), round_(round), random_(seed, round) {}

    Report run() {
        // Draw a scene, and divide it in two. Some shapes are in both.
        Places<T, D> places(random_);
        auto shapes = scene<Shape>(places);
        if (shapes.size() > 200) shapes.resize(200);
        for (const Shape& shape : shapes) {
            const auto in = random_.bits() % 8;
            if (in < 5) one_.push_back(shape);
            if (in > 3) two_.push_back(shape);
        }
        if (one_.empty() || two_.empty()) return {};
        const auto corners = corners_of(shapes, Vec<T, D>());
        const auto corner = [&] { return corners[random_.bits() % corners.size()]; };
        radius_ = random_.bits() % 16 == 0 ? 0 : double(length(corner() - corner()));
        look_at<Bvh, Bvh>("Bvh, Bvh");
        look_at<WideBvh, WideBvh>("WideBvh, WideBvh");
        look_at<KdTree, WideBvh>("KdTree, WideBvh");
        look_at<BspTree, Grid>("BspTree, Grid");
        look_at<Grid, Orthtree>("Grid, Orthtree");
        look_at<Orthtree, TwoLevelGrid>("Orthtree, TwoLevelGrid");
        look_at<TwoLevelGrid, KdTree>("TwoLevelGrid, KdTree");
        look_at<BruteForce, BspTree>("BruteForce, BspTree");
        if constexpr (std::is_same_v<Shape, Vec<T, D>>) {
            look_at<PointKdTree, HashGrid>("PointKdTree, HashGrid");
            look_at<HashGrid, PointKdTree>("HashGrid, PointKdTree");
            look_at<HashGrid, PointOrthtree>("HashGrid, PointOrthtree");
        }
        return std::move(report_);
    }

private:
    using Set = decltype(set_of(std::vector<Shape>()));
    using T = typename Set::Scalar;
    static constexpr int D = Set::dimension;

    template <template <class, int> class SA, template <class, int> class SB>
    void look_at(const char* names) {
        const auto fails = [&](const auto& one, const auto& two) {
            try {
                return !pairs_as_all_pairs<SA, SB>(one, two, radius_);
            } catch (const InputError&) {
                return false;
            }
        };
        report_.questions += 4;
        if (!fails(one_, two_)) return;
        // Shrink both sets, and report the fault as a test that fails.
        auto one = one_, two = two_;
        one = fewer(one, [&](const auto& some) { return fails(some, two); });
        two = fewer(two, [&](const auto& some) { return fails(one, some); });
        std::ostringstream out;
        out << "// Seed " << seed_ << ", round " << round_ << ".\nTEST(Found, Round" << seed_ << 'x' << round_
            << ") {\n";
        for (const auto& [name, shapes] : {std::pair("one", &one), std::pair("two", &two)}) {
            out << "    const std::vector<" << name_of(shapes->front()) << "> " << name << " = {";
            for (const auto& shape : *shapes) hunter::write(out, shape), out << ", ";
            out << "};\n";
        }
        out << "    EXPECT_TRUE((pairs_as_all_pairs<" << names << ">(one, two, ";
        hunter::write(out, radius_);
        out << ")));\n}\n";
        report_.found.push_back(out.str());
    }

    std::uint64_t seed_, round_;
    Random random_;
    std::vector<Shape> one_, two_;
    double radius_ = 0;
    Report report_;
};

}  // namespace

Report hunt_pairs(std::uint64_t seed, std::uint64_t round) {
    switch (round / 16 % 5) {
        case 0:
            return HuntPairs<Vec<float, 3>>(seed, round).run();
        case 1:
            return HuntPairs<Vec<double, 2>>(seed, round).run();
        case 2:
            return HuntPairs<Triangle<double, 3>>(seed, round).run();
        default:
            return HuntPairs<Triangle<float, 3>>(seed, round).run();
    }
}

}  // namespace hedgerow::hunter
