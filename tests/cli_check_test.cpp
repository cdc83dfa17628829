/// `info --check` finds the faults of a mesh, and where they are.
#include <fstream>

#include <nlohmann/json.hpp>

#include <hedgerow/ask/pairs.h>
#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/generate.h>

#include "tool.h"

namespace {

using namespace hedgerow;
using nlohmann::json;

class Check : public ToolTest {
protected:
    json check(const std::string& scene) const {
        const auto r = run("info --check --json " + scene);
        EXPECT_EQ(r.code, 0) << r.output;
        return json::parse(r.output)["check"];
    }
    /// Writes an OBJ file. Each tetrahedron has its right corner at (x, 0, 0), and its legs have length 1.
    /// `faces` are of its corners 0 to 3.
    struct Tetrahedron {
        int x;
        std::vector<std::array<int, 3>> faces;
    };
    std::string written(const std::string& name, const std::vector<Tetrahedron>& all,
                        const std::string& more = "") const {
        std::ofstream out(file(name));
        int vertices = 0;
        for (const auto& t : all) {
            out << "v " << t.x << " 0 0\nv " << t.x + 1 << " 0 0\nv " << t.x << " 1 0\nv " << t.x << " 0 1\n";
            for (const auto& f : t.faces)
                out << "f " << vertices + f[0] + 1 << " " << vertices + f[1] + 1 << " " << vertices + f[2] + 1
                    << "\n";
            vertices += 4;
        }
        out << more;
        return file(name);
    }
    const std::vector<std::array<int, 3>> outward = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    const std::vector<std::array<int, 3>> inward = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
};

TEST_F(Check, AClosedMeshHasNoFaults) {
    for (const std::string& scene : {std::string("gen:cube:300"), written("whole.obj", {{0, outward}})}) {
        const json found = check(scene);
        for (const char* kind :
             {"open_edges", "holes", "turned_edges", "inward_parts", "zero_area_triangles",
              "duplicated_triangles", "unused_vertices", "vertices_not_finite", "self_intersections"})
            EXPECT_EQ(found[kind], 0) << scene << ", " << kind;
        EXPECT_EQ(found["parts"], 1) << scene;
        EXPECT_EQ(found["closed_parts"], 1) << scene;
        EXPECT_NE(run("info --check " + scene).output.find("\nno faults\n"), std::string::npos);
    }
}

TEST_F(Check, HolesAreLoopsOfOpenEdges) {
    // The second lacks its largest face, and the third two faces, whose common edge then has no triangle.
    const auto scene =
        written("open.obj",
                {{0, outward}, {10, {outward[0], outward[1], outward[2]}}, {20, {outward[0], outward[1]}}});
    const json found = check(scene);
    EXPECT_EQ(found["open_edges"], 3 + 4);
    EXPECT_EQ(found["holes"], 2);
    EXPECT_EQ(found["turned_edges"], 0);
    EXPECT_EQ(found["parts"], 3);
    EXPECT_EQ(found["closed_parts"], 1);
    // Around the third: two legs and two sides, 2 + 2√2, less than the 3√2 of the second's largest face.
    EXPECT_EQ(found["longest_hole"]["edges"], 4);
    EXPECT_NEAR(found["longest_hole"]["length"].get<double>(), 2 + 2 * std::sqrt(2), 1e-6);
    EXPECT_EQ(found["longest_hole"]["around"], json({20.5, 0.5, 0.5}));
    EXPECT_NE(run("info --check " + scene).output.find("2 loops; the longest: 4 edges"), std::string::npos);
}

TEST_F(Check, LoopsThatTouchAreCounted) {
    // Two triangles that share a corner, and two whose corners are written twice.
    std::ofstream(file("bow.obj")) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nf 1 2 3\nf 1 4 5\n";
    EXPECT_EQ(check(file("bow.obj"))["holes"], 2);
    std::ofstream(file("quad.obj"))
        << "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 4 5 6\n";
    const json quad = check(file("quad.obj"));
    EXPECT_EQ(quad["open_edges"], 4);
    EXPECT_EQ(quad["holes"], 1);
    EXPECT_EQ(quad["parts"], 1);
    // Three triangles at one edge: its count is odd, too.
    std::ofstream(file("fan.obj"))
        << "v 0 0 0\nv 0 0 1\nv 1 0 0\nv 0 1 0\nv -1 0 0\nf 1 2 3\nf 1 2 4\nf 2 1 5\n";
    const json fan = check(file("fan.obj"));
    EXPECT_EQ(fan["open_edges"], 7);
    EXPECT_EQ(fan["holes"], 2);
}

TEST_F(Check, TrianglesThatAreTurned) {
    auto one_turned = outward;
    std::swap(one_turned[3][0], one_turned[3][1]);
    const auto scene = written("turned.obj", {{0, outward}, {10, inward}, {20, one_turned}});
    const json found = check(scene);
    EXPECT_EQ(found["turned_edges"], 3);
    EXPECT_EQ(found["open_edges"], 0);
    EXPECT_EQ(found["inward_parts"], 1);
    EXPECT_EQ(found["closed_parts"], 2);
    EXPECT_GE(found["first_turned_edge"][0][0], 20);
    EXPECT_NE(run("info --check " + scene).output.find("of 2 closed; inside out"), std::string::npos);
}

TEST_F(Check, TrianglesTwiceOrWithoutArea) {
    // Triangle 4 is face 3 the other way round, and triangle 5 has no area.
    const json found = check(written("bad.obj", {{0, outward}}, "v 7 7 7\nf 2 4 3\nf 1 1 2\n"));
    EXPECT_EQ(found["duplicated_triangles"], 1);
    EXPECT_EQ(found["first_duplicates"], json({{3, 4}}));
    EXPECT_EQ(found["zero_area_triangles"], 1);
    EXPECT_EQ(found["first_zero_area_triangles"], json({5}));
    EXPECT_EQ(found["unused_vertices"], 1);
    EXPECT_GE(found["self_intersections"], 1);
}

TEST_F(Check, IntersectionsAreThoseOfTheLibrary) {
    for (const char* precision : {"float", "double"}) {
        const json found = check("gen:soup:2000 --precision " + std::string(precision));
        const auto expect = [&]<class T>(T) {
            const auto mesh = std::get<TriangleMesh<T>>(generate<T>(parse_scene_spec("gen:soup:2000")));
            const auto index = build<WideBvh>(mesh);
            std::vector<ElementPair> pairs;
            ASSERT_GT(self_intersections(index, pairs), 0u);
            EXPECT_EQ(found["self_intersections"], pairs.size());
            EXPECT_EQ(found["first_self_intersections"][0], json({pairs[0].a, pairs[0].b}));
        };
        precision == std::string("float") ? expect(float()) : expect(double());
        EXPECT_EQ(found["open_edges"], 6000);
        EXPECT_EQ(found["holes"], 2000);
    }
}

TEST_F(Check, IsOfTriangles) {
    expect_bad("info --check gen:points:20", "no triangles");
    expect_bad("info --check gen:segments2d:20", "no triangles");
    EXPECT_NE(run("info --help").output.find("exit code is 0 with faults"), std::string::npos);
}

}  // namespace
