/// What the tool says of files: what was left out, rounded or not read, and numbers as in the file.
#include "query_tool.h"

namespace hedgerow {
namespace {

class Files : public QueryTest {
protected:
    std::string answers(const std::string& arguments, const std::string& scene,
                        const std::string& rows) const {
        write("q.csv", rows);
        const auto r = run("query " + arguments + " " + file(scene) + " --from " + file("q.csv") +
                           " -o - --output-format csv --quiet");
        EXPECT_EQ(r.code, 0) << r.output;
        return r.output;
    }
    static void expect_told(const ToolResult& r, const std::string& said) {
        EXPECT_EQ(r.code, 0) << r.output;
        EXPECT_NE(r.output.find(said), std::string::npos) << r.output;
    }
};

TEST_F(Files, PointsKeepTheirNumbersWhereOthersAreLeftOut) {
    write("a.csv", "x,y,z\n0,0,0\nnan,nan,nan\n1,0,0\n2,0,0\ninf,0,0\n");
    const std::string told = "hedgerow: " + file("a.csv") + ": 2 points were left out\n";
    EXPECT_EQ(answers("nearest -k 2 --drop-bad", "a.csv", "0.75,0,0\n"),
              told + "query,primitive,distance\n0,2,0.25\n0,0,0.75\n");
    EXPECT_NE(answers("closest-point --drop-bad", "a.csv", "1.75,0,0\n").find("\n3,0.25,"),
              std::string::npos);
    EXPECT_EQ(answers("overlap --radius 1.5 --drop-bad", "a.csv", "1,0,0\n"),
              told + "query,primitive\n0,0\n0,2\n0,3\n");
    const auto pairs = run("query pairs-within " + file("a.csv") + " --radius 1 --drop-bad --quiet -o - " +
                           "--output-format csv");
    EXPECT_EQ(pairs.output, told + "a,b,distance\n0,2,1\n2,3,1\n");
    expect_told(run("info --json --drop-bad " + file("a.csv")), "\"dropped\": 2");
    expect_told(run("convert --drop-bad " + file("a.csv") + " -o " + file("b.xyz")),
                "2 points were left out");
    expect_told(run("build --drop-bad " + file("a.csv") + " -o " + file("a.hedgerow")), "has no numbers of");
    // Of a mesh faces are counted.
    write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nf 1 2 3\nf 1 2 4\n");
    expect_told(run("info --drop-bad " + file("a.obj")), "1 faces were left out, with 1 vertices");
}

TEST_F(Files, CoordinatesThatFloatsLoseAreReadInDouble) {
    write("utm.csv", "x,y,z\n431234,5412345.2,210\n431234,5412345.7,210\n");
    const std::string row = "431234,5412345.3,210\n";
    EXPECT_NE(answers("nearest -k 1", "utm.csv", row).find("\n0,0,0.0999"), std::string::npos);
    expect_told(run("info " + file("utm.csv")),
                "is read in double, since floats would move its coordinates by up to 0.2");
    expect_told(run("info --precision float " + file("utm.csv")), "floats move its coordinates by up to 0.2");
    // Where doubles cannot be asked for, none are promised.
    write("utm.obj", "v 431234 5412345.2 210\nv 431234 5412345.7 210\nv 431235 5412345.2 210\nf 1 2 3\n");
    const auto bench = run("bench --quick --sets primary " + file("utm.obj"));
    expect_told(bench, "floats move its coordinates by up to 0.2");
    EXPECT_EQ(bench.output.find("--precision"), std::string::npos);
    // Files of which parts are read after each other.
    write("utm.stl",
          "solid a\nfacet normal 0 0 1\nouter loop\nvertex 431234 5412345.2 210\nvertex 431234.5 5412345.2 "
          "210\nvertex 431234 5412345.7 210\nendloop\nendfacet\nendsolid a\n");
    const std::string raster =
        "render --visibility raster --size 8x8 -o " + file("p.png") + " " + file("utm.stl");
    expect_told(run(raster), "is read in double, since floats would move its coordinates by up to 0.2");
    expect_told(run(raster + " --precision float"), "floats move its coordinates by up to 0.2");
    // Nothing is said of ordinary files.
    write("a.csv", "x,y,z\n0.1,0.2,0.3\n1.1,0.2,0.3\n0.1,1.2,0.3\n");
    EXPECT_EQ(run("info " + file("a.csv") + " --quiet").output.find("double"), std::string::npos);
    EXPECT_EQ(run("info " + file("utm.csv") + " --precision double --quiet").output.find("double"),
              std::string::npos);
}

TEST_F(Files, NumbersThatStlCannotHoldAreRefused) {
    write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1e100 0\nf 1 2 3\n");
    expect_bad("convert " + file("a.obj") + " -o " + file("a.stl"), "1e+100");
}

TEST_F(Files, CoordinatesThatStlMovesAreTold) {
    write("utm.obj", "v 431234 5412345.2 210\nv 431234 5412345.7 210\nv 431235 5412345.2 210\nf 1 2 3\n");
    expect_told(run("convert " + file("utm.obj") + " -o " + file("utm.stl")),
                file("utm.stl") + ": its floats move coordinates by up to 0.2, which matters. .ply");
    EXPECT_EQ(run("convert --quiet " + file("utm.obj") + " -o " + file("utm.ply")).output, "");
    write("a.obj", "v 0.1 0.2 0.3\nv 1.1 0.2 0.3\nv 0.1 1.2 0.3\nf 1 2 3\n");
    EXPECT_EQ(run("convert --quiet " + file("a.obj") + " -o " + file("a.stl")).output, "");
}

TEST_F(Files, InfoAndCheckAgreeWhatIsClosed) {
    // A cube whose every side has corners of its own.
    std::string text;
    for (const char* side : {"v 0 0 0\nv 0 1 0\nv 1 1 0\nv 1 0 0\n", "v 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n",
                             "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\n", "v 1 0 0\nv 1 1 0\nv 1 1 1\nv 1 0 1\n",
                             "v 1 1 0\nv 0 1 0\nv 0 1 1\nv 1 1 1\n", "v 0 1 0\nv 0 0 0\nv 0 0 1\nv 0 1 1\n"})
        text += std::string(side) + "f -4 -3 -2 -1\n";
    write("cube.obj", text);
    const auto r = run("info --json --check --quiet " + file("cube.obj"));
    expect_told(r, "\"closed\": true");
    expect_told(r, "\"closed_parts\": 1");
    EXPECT_EQ(r.output.find("\"open_edges\": 1"), std::string::npos) << r.output;
}

TEST_F(Files, PeculiaritiesAreTold) {
    write("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 2 1 0\n");
    expect_told(run("info " + file("a.off")), "something follows the faces");
    write("pts.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    expect_told(run("info " + file("pts.obj")), "\"points\"");
    write("a.obj", "mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 2/2 3/3\n");
    expect_told(run("render " + file("a.obj") + " --shading colour --size 8x8 -o " + file("a.png")),
                "name texture coordinates, and there are none");
    // Materials behind a byte order mark.
    write("mark.mtl", "\xEF\xBB\xBFnewmtl a\nKd 0 1 0\n");
    write("mark.obj", "mtllib mark.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
    const auto r =
        run("render " + file("mark.obj") + " --shading colour --size 8x8 --quiet -o " + file("m.png"));
    EXPECT_EQ(r.output, "");
    // Rows behind one.
    write("a.csv", "0,0,0\n1,0,0\n");
    write("q.json", "\xEF\xBB\xBF[[0.9,0,0]]");
    expect_told(run("query closest-point " + file("a.csv") + " --from " + file("q.json") +
                    " --quiet -o - --output-format csv"),
                "\n1,0.1");
}

}  // namespace
}  // namespace hedgerow
