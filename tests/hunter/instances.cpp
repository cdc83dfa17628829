/// Rounds of the hunter over instances of triangles: transforms that turn, scale by powers of two, squeeze,
/// mirror and move far.
#include "instances.h"

#include <sstream>

#include "report.h"
#include "scenes.h"
#include "shrink.h"

namespace hedgerow::hunter {

namespace {

std::vector<Transform<3>> any_places(Random& random) {
    std::vector<Transform<3>> places;
    const std::size_t count = 1 + random.bits() % 12;
    while (places.size() < count) {
        Vec3d scales = Vec3d::all(1), by;
        const auto kind = random.bits() % 4;
        // Scale by powers of two, evenly or unevenly, and move by multiples of 0.1.
        const double size = std::ldexp(1.0, static_cast<int>(random.bits() % 41) - 20);
        for (int k = 0; k < 3; ++k) {
            if (kind == 1) scales[k] = size;
            if (kind == 2)
                scales[k] =
                    std::ldexp(random.bits() % 4 == 0 ? -1.0 : 1.0, static_cast<int>(random.bits() % 13) - 6);
            by[k] = nasty::nudged(0.1 * static_cast<double>(random.bits() % 41),
                                  static_cast<int>(random.bits() % 3));
        }
        // Move one in eight far away.
        Transform<3> place = Transform<3>::translation(by * (random.bits() % 8 == 0 ? 1e6 : 1.0));
        // Turn three in four, half of them about an axis and half of them by right angles.
        if (random.bits() % 4 != 0) {
            const int axis = static_cast<int>(random.bits() % 3);
            Vec3d about;
            about[axis] = 1;
            if (random.bits() % 2 == 0) about = random.direction<3>();
            const double angle = random.bits() % 2 == 0 ? pi / 2 * static_cast<double>(random.bits() % 4)
                                                        : random.uniform(-pi, pi);
            place = place * Transform<3>::rotation(about, angle);
        }
        places.push_back(place * Transform<3>::scaling(scales));
        // Repeat a placement now and then.
        if (random.bits() % 8 == 0) places.push_back(places[random.bits() % places.size()]);
    }
    return places;
}

void write_place(std::ostream& out, const Transform<3>& place) {
    out << "{{{";
    for (std::size_t row = 0; row < 3; ++row) {
        if (row > 0) out << ", ";
        hunter::write(out, place.there().linear[row]);
    }
    out << "}}, ";
    hunter::write(out, place.there().shift);
    out << '}';
}

template <class T>
class HuntInstances {
public:
    HuntInstances(std::uint64_t seed, std::uint64_t round)
        : seed_(seed), round_(round), random_(seed, round) {}

    Report run() {
        // Draw a mesh, its placements and queries.
        Places<T, 3> places(random_);
        shapes_ = scene<Triangle<T, 3>>(places);
        if (shapes_.size() > 64) shapes_.resize(64);
        places_ = any_places(random_);
        std::vector<Vec<T, 3>> corners;
        for (const auto& corner : corners_of(shapes_, Vec<T, 3>()))
            for (const auto& place : places_) corners.push_back(transformed(place.there(), corner));
        Asking<T, 3> asking(places, corners);
        questions_ = asking.questions(64, 16);
        try {
            // Compare pairs of structures with brute force over brute force.
            const TwoLevels<BruteForce, BruteForce, T> truth(shapes_, places_);
            look_at<WideBvh, WideBvh>("WideBvh, WideBvh", truth);
            look_at<Bvh, WideBvh>("Bvh, WideBvh", truth);
            look_at<Grid, Bvh>("Grid, Bvh", truth);
            look_at<KdTree, Grid>("KdTree, Grid", truth);
            look_at<Orthtree, KdTree>("Orthtree, KdTree", truth);
            look_at<BspTree, WideBvh>("BspTree, WideBvh", truth);
        } catch (const InputError&) {
            // A transform that takes the scene beyond the bounds of coordinates is refused.
        }
        return std::move(report_);
    }

private:
    template <template <class, int> class Outer, template <class, int> class Inner, class Truth>
    void look_at(const char* names, const Truth& truth) {
        const TwoLevels<Outer, Inner, T> levels(shapes_, places_);
        const auto all = [&](const auto& questions) {
            for (const auto& question : questions) {
                ++report_.questions;
                if (!(levels.answer(question) == truth.answer(question)))
                    return differs<Outer, Inner>(names, question);
            }
        };
        all(questions_.rays), all(questions_.points), all(questions_.boxes);
    }
    template <template <class, int> class Outer, template <class, int> class Inner, class Question>
    void differs(const char* names, Question question) {
        // Shrink the placements, the shapes and the query.
        auto shapes = shapes_;
        auto places = places_;
        const auto fails = [&](const auto& some, const auto& at, const Question& asked) {
            try {
                return !placed_as_brute_force<Outer, Inner>(some, at, asked);
            } catch (const InputError&) {
                return false;
            }
        };
        places = fewer(places, [&](const auto& some) { return fails(shapes, some, question); });
        shrink(shapes, question,
               [&](const auto& some, const Question& asked) { return fails(some, places, asked); });
        // Report the fault as a test that fails.
        std::ostringstream out;
        out << "// Seed " << seed_ << ", round " << round_ << ".\nTEST(Found, Round" << seed_ << 'x' << round_
            << ") {\n"
            << "    const std::vector<Triangle<" << scalar_name<T> << ", 3>> shapes = {";
        for (const auto& shape : shapes) hunter::write(out, shape), out << ", ";
        out << "};\n    const std::vector<Transform<3>> places = {";
        for (const auto& place : places) write_place(out, place), out << ", ";
        out << "};\n    const " << name_of(question) << " question = ";
        hunter::write(out, question);
        out << ";\n    EXPECT_TRUE((placed_as_brute_force<" << names << ">(shapes, places, question)));\n}\n";
        report_.found.push_back(out.str());
    }

    std::uint64_t seed_, round_;
    Random random_;
    std::vector<Triangle<T, 3>> shapes_;
    std::vector<Transform<3>> places_;
    AllGiven<T, 3> questions_;
    Report report_;
};

}  // namespace

Report hunt_instances(std::uint64_t seed, std::uint64_t round) {
    return round / 16 % 2 == 0 ? HuntInstances<float>(seed, round).run()
                               : HuntInstances<double>(seed, round).run();
}

}  // namespace hedgerow::hunter
