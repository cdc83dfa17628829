/// EXR images: OpenEXR reads every bit back, bad input is refused, and what the tool writes agrees with the
/// library's answers for the same rays.
#include <hedgerow/io/exr.h>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStringAttribute.h>

#include <bit>
#include <limits>
#include <map>

#include <hedgerow/any_index.h>
#include <hedgerow/io/image.h>
#include <hedgerow/render/camera/presets.h>
#include <hedgerow/render/render.h>
#include <hedgerow/scenes/generate.h>

#include "io_support.h"
#include "structure_names.h"
#include "tool.h"

namespace hedgerow {
namespace {

using namespace testing_io;

/// The channels that OpenEXR reads from a file, by their names: FLOAT values as their bits, UINT values as
/// they are.
struct Read {
    int width = 0, height = 0;
    std::map<std::string, std::vector<std::uint32_t>> words;
    std::map<std::string, Imf::PixelType> types;

    explicit Read(const std::filesystem::path& path) {
        Imf::InputFile file(path.c_str());
        EXPECT_TRUE(file.isComplete());
        const auto window = file.header().dataWindow();
        width = window.max.x + 1, height = window.max.y + 1;
        EXPECT_EQ(window.min, Imath::V2i(0, 0));
        EXPECT_EQ(file.header().displayWindow(), window);
        Imf::FrameBuffer buffer;
        const auto row = static_cast<std::size_t>(width);
        const auto& channels = file.header().channels();
        for (auto c = channels.begin(); c != channels.end(); ++c) {
            auto& to = words[c.name()];
            to.resize(row * static_cast<std::size_t>(height));
            types[c.name()] = c.channel().type;
            buffer.insert(c.name(),
                          Imf::Slice(c.channel().type, reinterpret_cast<char*>(to.data()), 4, 4 * row));
        }
        file.setFrameBuffer(buffer);
        file.readPixels(0, height - 1);
    }
    float value(const std::string& name, std::size_t pixel) const {
        EXPECT_EQ(types.at(name), Imf::FLOAT);
        return std::bit_cast<float>(words.at(name).at(pixel));
    }
    std::uint32_t id(std::size_t pixel) const {
        EXPECT_EQ(types.at("id"), Imf::UINT);
        return words.at("id").at(pixel);
    }
    Vec3f vector(const std::string& x, const std::string& y, const std::string& z, std::size_t pixel) const {
        return {value(x, pixel), value(y, pixel), value(z, pixel)};
    }
};

TEST(Exr, EveryBitIsReadBack) {
    TempFolder folder;
    std::mt19937_64 random(3);
    for (int round = 0; round < 50; ++round) {
        // 40 rows are three blocks of 16, the last one short.
        const int width = 1 + static_cast<int>(random() % 40), height = 1 + static_cast<int>(random() % 40);
        const auto count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
        struct Pixel {
            float depth;
            std::uint32_t id;
        };
        // Draw values of all bits, some of them interleaved, and set an infinity of each sign and a NaN.
        std::vector<Pixel> pixels(count);
        std::vector<float> light(count);
        for (auto& p : pixels)
            p = {std::bit_cast<float>(static_cast<std::uint32_t>(random())),
                 static_cast<std::uint32_t>(random())};
        for (auto& v : light) v = random_coordinate<float>(random);
        pixels[0].depth = std::numeric_limits<float>::infinity();
        pixels[count / 2].depth = -std::numeric_limits<float>::infinity();
        pixels[count - 1].depth = std::bit_cast<float>(0x7FC12345u);  // a NaN with a payload
        save_exr(folder / "a.exr", {width,
                                    height,
                                    {{"R", Strided<float>(light)},
                                     {"depth.Z", Strided<float>(&pixels[0].depth, count, sizeof(Pixel))},
                                     {"id", Strided<std::uint32_t>(&pixels[0].id, count, sizeof(Pixel))}}});
        // Compare with what OpenEXR reads.
        const Read read(folder / "a.exr");
        ASSERT_EQ(read.width, width);
        ASSERT_EQ(read.height, height);
        ASSERT_EQ(read.words.size(), 3u);
        for (std::size_t i = 0; i < count; ++i) {
            ASSERT_EQ(read.words.at("R")[i], std::bit_cast<std::uint32_t>(light[i]));
            ASSERT_EQ(read.words.at("depth.Z")[i], std::bit_cast<std::uint32_t>(pixels[i].depth));
            ASSERT_EQ(read.id(i), pixels[i].id);
        }
    }
    EXPECT_EQ(folder.file_count(), 1u);
}

TEST(Exr, ManyChannelsWithLongNames) {
    TempFolder folder;
    const std::vector<float> values(6, 2.5f);
    Layers layers{3, 2, {}};
    for (int k = 0; k < 100; ++k) {
        layers.channels.push_back({std::to_string(k) + ".", Strided<float>(values)});
        layers.channels.back().name.resize(255, 'x');
    }
    save_exr(folder / "a.exr", layers);
    EXPECT_EQ(Read(folder / "a.exr").words.size(), 100u);
}

TEST(Exr, KeepsNotes) {
    TempFolder folder;
    const std::vector<float> values(6, 2.5f);
    const Layers layers{3, 2, {{"Y", Strided<float>(values)}}};
    save_exr(folder / "a.exr", layers, {}, {{"Command", "draw h\u00e4.ply"}, {"Seed", "7"}});
    const Imf::InputFile file((folder / "a.exr").c_str());
    EXPECT_EQ(file.header().typedAttribute<Imf::StringAttribute>("command").value(), "draw h\u00e4.ply");
    EXPECT_EQ(file.header().typedAttribute<Imf::StringAttribute>("seed").value(), "7");
    for (const Note& note : {Note{"", "a"}, Note{"Channels", "a"}, Note{"seed", "8"}})
        expect_input_error(
            [&] {
                save_exr(folder / "b.exr", layers, {}, {{"Seed", "1"}, note});
            },
            {"b.exr", "note"});
    EXPECT_EQ(folder.file_count(), 1u);
}

TEST(Exr, BadInput) {
    TempFolder folder;
    const std::vector<float> four_values(4), three_values(3);
    const Strided<float> four(four_values), three(three_values);
    const auto save = [&](int width, int height, std::vector<Channel> channels, const char* name = "a.exr") {
        save_exr(folder / name, {width, height, std::move(channels)});
    };
    const Channel good{"R", four};
    // Images that no file can have.
    expect_input_error([&] { save(2, 2, {}); }, {"a.exr", "without channels"});
    expect_input_error([&] { save(0, 0, {{"R", Strided<float>()}}); }, {"a.exr", "0x0"});
    expect_input_error([&] { save(-2, -2, {good}); }, {"a.exr", "-2x-2"});
    expect_input_error([&] { save(2, 2, {good, {"G", three}}); }, {"a.exr", "2x2", "3 values of G"});
    expect_input_error([&] { save(2, 2, {good, good}); }, {"a.exr", "two channels", "\"R\""});
    for (const std::string& name : {std::string(), std::string(256, 'x'), std::string("a\0b", 3)})
        expect_input_error([&] { save(2, 2, {{name, four}}); }, {"a.exr", "the name of channel 1"});
    // Files that cannot be written.
    expect_output_error([&] { save(2, 2, {good}, "none/a.exr"); }, {"none/a.exr", "cannot be written"});
    expect_output_error([&] { save(2, 2, {good}, "."); }, {"directory"});
    EXPECT_EQ(folder.file_count(), 0u);
    // A save that fails leaves the earlier file.
    save(2, 2, {good});
    const std::string before = contents(folder / "a.exr");
    expect_input_error([&] { save(2, 2, {{"R", three}}); }, {"3 values"});
    EXPECT_EQ(contents(folder / "a.exr"), before) << "what was there stays until it is replaced";
    if (std::filesystem::exists("/dev/full")) {
        const std::vector<float> many(1000000, 1);
        expect_output_error(
            [&] {
                save_exr("/dev/full", {1000, 1000, {{"R", Strided<float>(many)}}});
            },
            {"cannot be written"});
    }
}

/// Compares the layers of a picture with the answers for the rays through its pixels' first samples.
template <class T>
void expect_what_rays_see(const Read& read, const AnyIndex<T, 3>& index, const TriangleMesh<T>& mesh,
                          const std::vector<Ray<T, 3>>& rays, bool counts) {
    ASSERT_EQ(read.words.size(), 11u);
    int hits = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        Hit<T> hit;
        Visits visits;
        closest_hits(index, {&rays[i], 1}, {&hit, 1}, {}, KeepAll(), std::span(&visits, 1));
        ASSERT_EQ(read.value("depth.Z", i), static_cast<float>(hit.t)) << i;
        ASSERT_EQ(read.id(i), hit.primitive) << i;
        const Vec3f normal = read.vector("normal.X", "normal.Y", "normal.Z", i);
        if (hit) {
            EXPECT_NEAR(length(normal), 1, 1e-6);
            EXPECT_LT(dot(normal, Vec3f(rays[i].direction)), 0);
            const Vec3f own(normalized(Vec3d(view_of(mesh).normal(hit.element))));
            EXPECT_NEAR(std::abs(dot(normal, own)), 1, 1e-6);
            ++hits;
        } else {
            ASSERT_EQ(normal, Vec3f());
        }
        if (!counts) continue;
        ASSERT_EQ(read.value("nodes", i), static_cast<float>(visits.nodes)) << i;
        ASSERT_EQ(read.value("leaves", i), static_cast<float>(visits.leaves)) << i;
        ASSERT_EQ(read.value("primitives", i), static_cast<float>(visits.primitives)) << i;
    }
    EXPECT_GT(hits, 100);
    EXPECT_LT(hits, static_cast<int>(rays.size()));
}
template <class T>
std::vector<Ray<T, 3>> rays_through_middles(const RenderOptions& o) {
    const RayMaker maker(o.camera, o.width, o.height);
    std::vector<Ray<T, 3>> rays;
    for (int y = 0; y < o.height; ++y)
        for (int x = 0; x < o.width; ++x)
            rays.push_back(maker.ray<T>(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f));
    return rays;
}

class ExrTool : public ToolTest {
protected:
    /// Runs the tool, which must succeed, and reads the file that it writes.
    Read written(const std::string& arguments) {
        const auto r = run(arguments + " --quiet -o " + file("a.exr"));
        EXPECT_EQ(r.code, 0) << r.output;
        return Read(file("a.exr"));
    }
};

template <class T>
void expect_tool_agrees(const Read& read, const std::string& structure) {
    const TriangleMesh<T> mesh = teapot<T>(500);
    const auto index = build_any(structure, mesh);
    RenderOptions options;
    options.width = 48, options.height = 32;
    options.camera = automatic_camera({Vec3f(index->bounds().low), Vec3f(index->bounds().high)});
    ASSERT_EQ(read.width, 48);
    ASSERT_EQ(read.height, 32);
    expect_what_rays_see(read, *index, mesh, rays_through_middles<T>(options), true);
}

TEST_F(ExrTool, LayersAreWhatTheLibraryAnswers) {
    for (const std::string& structure : structures_for<TriangleMesh<float>>()) {
        const std::string render = "render gen:teapot:500 --size 48x32 --structure " + structure;
        expect_tool_agrees<float>(written(render), structure);
        expect_tool_agrees<double>(written(render + " --precision double"), structure);
    }
}

TEST_F(ExrTool, PathsHaveTheLayersOfDenoisers) {
    const std::string render = "render gen:cornell-box --shading path --spp 8 --size 24x20";
    const Read read = written(render);
    ASSERT_EQ(run(render + " --quiet -o " + file("a.png")).code, 0);
    const Image image = load_png(file("a.png"));
    std::size_t seen = 0, both = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        ASSERT_EQ(srgb(read.vector("R", "G", "B", i)), image.pixels[i]) << i;
        EXPECT_EQ(read.words.at("samples")[i], 8u);
        EXPECT_GE(read.value("error", i), 0);
        const Vec3f light = read.vector("R", "G", "B", i),
                    direct = read.vector("direct.R", "direct.G", "direct.B", i),
                    indirect = read.vector("indirect.R", "indirect.G", "indirect.B", i);
        for (int k = 0; k < 3; ++k) ASSERT_NEAR(direct[k] + indirect[k], light[k], 1.2e-7f * light[k]) << i;
        both += max_component(direct) > 0 && max_component(indirect) > 0;
        EXPECT_EQ(read.value("uv.U", i) + read.value("uv.V", i), 0) << "no texture coordinates";
        const Vec3f albedo = read.vector("albedo.R", "albedo.G", "albedo.B", i),
                    normal = read.vector("normal.X", "normal.Y", "normal.Z", i);
        EXPECT_LE(max_component(albedo), 1);
        EXPECT_LE(length(normal), 1.00001f);
        if (read.words.at("id")[i] == Hit<float>::none) continue;
        ++seen;
        EXPECT_LT(read.words.at("id")[i], 32u);
        EXPECT_EQ(read.words.at("instance")[i], 0u);
        EXPECT_GT(read.value("depth.Z", i), 0);
        EXPECT_GT(max_component(albedo), 0);
    }
    EXPECT_GT(seen, 300u);
    EXPECT_GT(both, 200u) << "pixels with direct and with indirect light";
}

/// Direct light goes on from a state, whatever file it is of in between. A state that has been begun without
/// goes on without, and says so.
TEST_F(ExrTool, PathsGoOnWithTheirDirectLight) {
    for (const std::string division : {"", "--adaptive"}) {
        const std::string render = "render gen:cornell-box --shading path --size 24x20 " + division,
                          state = " --resume " + file("state" + division);
        const Read at_once = written(render + " --spp 40");
        (void)written(render + " --spp 8" + state);
        ASSERT_EQ(run(render + " --spp 34 --quiet -o " + file("a.png") + state).code, 0);
        const Read resumed = written(render + " --spp 40" + state);
        EXPECT_EQ(at_once.words, resumed.words) << division;
        EXPECT_EQ(at_once.words.count("direct.R"), 1u);
    }
    const std::string render =
        "render gen:cornell-box --shading path --size 24x20 --quiet --resume " + file("of_png") + " --spp ";
    ASSERT_EQ(run(render + "2 -o " + file("b.png")).code, 0);
    const auto r = run(render + "4 -o " + file("b.exr"));
    EXPECT_EQ(r.code, 0);
    EXPECT_NE(r.output.find("warning: " + file("of_png") + " was begun for a .png"), std::string::npos)
        << r.output;
    const Read read(file("b.exr"));
    EXPECT_EQ(read.words.at("samples")[0], 4u);
    EXPECT_EQ(read.words.count("direct.R") + read.words.count("indirect.B"), 0u);
}

/// Light without noise is beside the raw light, which is the mean of both halves, and is what a .png shows.
TEST_F(ExrTool, DenoisedPathsAreALayerOfTheirOwn) {
    const std::string render = "render gen:cornell-box --shading path --spp 8 --size 24x20 --denoise";
    const Read read = written(render);
    ASSERT_EQ(run(render + " --quiet -o " + file("a.png")).code, 0);
    const Image image = load_png(file("a.png"));
    std::size_t differ = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const Vec3f denoised = read.vector("denoised.R", "denoised.G", "denoised.B", i);
        ASSERT_EQ(srgb(denoised), image.pixels[i]) << i;
        differ += denoised != read.vector("R", "G", "B", i);
    }
    EXPECT_GT(differ, 200u);
}

TEST_F(ExrTool, ColoursAreTheLightOfThePng) {
    for (const char* shading : {"normals", "depth", "diffuse"}) {
        const std::string render =
            std::string("render gen:teapot:500 --spp 3 --size 48x32 --shading ") + shading;
        const Read read = written(render);
        ASSERT_EQ(run(render + " --quiet -o " + file("a.png")).code, 0);
        const Image image = load_png(file("a.png"));
        for (std::size_t i = 0; i < image.pixels.size(); ++i)
            ASSERT_EQ(srgb(read.vector("R", "G", "B", i)), image.pixels[i]) << shading << ", pixel " << i;
    }
}

TEST_F(ExrTool, CountsAreNumbersAndNotHeat) {
    for (const char* verb : {"render --shading steps", "draw --heat steps --scale 3"}) {
        const Read read = written(verb + std::string(" gen:teapot:500 --size 200x150"));
        for (std::size_t i = 0; i < 200 * 150; ++i) {
            const float steps =
                read.value("nodes", i) + read.value("leaves", i) + read.value("primitives", i);
            ASSERT_EQ(read.vector("R", "G", "B", i), Vec3f(steps, steps, steps));
        }
    }
    const Read tests = written("draw gen:points:100 --heat tests --size 48x32");
    EXPECT_EQ(tests.words.at("R"), tests.words.at("primitives"));
    const Read time = written("draw gen:teapot:500 --heat time --size 48x32");
    for (std::size_t i = 0; i < 48 * 32; ++i) EXPECT_GT(time.value("G", i), 0);
}

TEST_F(ExrTool, OtherEndingsAreRefused) {
    for (const char* verb : {"render gen:cube -o ", "draw gen:cube --heat tests -o "})
        for (const char* name : {"x.jpg", "x.exr.gz", "x", ".exr"}) {
            expect_usage(verb + file(name), name);
            expect_usage(verb + file(name), ".png (colours) or .exr");
        }
    expect_failure(1, "render gen:cube -o " + file("no/such/folder/x.exr"), "no folder");
}

TEST_F(ExrTool, AnInterruptedRenderSavesWhatIsDone) {
    const std::string output = file("part.exr");
    EXPECT_EQ(run_interrupted_render(output), 130);
    EXPECT_FALSE(std::filesystem::exists(output)) << "that is for a whole picture";
    const Read read(file("part.unfinished.exr"));
    ASSERT_EQ(read.width, 1600);
    ASSERT_EQ(read.height, 1200);
    const auto &tested = read.words.at("primitives"), &red = read.words.at("R"), &id = read.words.at("id"),
               &depth = read.words.at("depth.Z"), &normal = read.words.at("normal.Z");
    constexpr auto infinity = std::bit_cast<std::uint32_t>(std::numeric_limits<float>::infinity());
    int missing = 0;
    for (std::size_t y = 0; y < 1200; ++y) {
        // Brute force tests all primitives, so the count of a ray that was cast is not 0.
        const bool done = tested[y * 1600] != 0;
        missing += !done;
        for (std::size_t i = y * 1600; i < (y + 1) * 1600; ++i) {
            ASSERT_EQ(tested[i] != 0, done) << "row " << y;
            ASSERT_EQ(red[i] != 0, done) << "row " << y;
            ASSERT_TRUE(done || (depth[i] == infinity && normal[i] == 0 && id[i] == Hit<float>::none));
        }
    }
    EXPECT_GT(missing, 0);
}

TEST(RenderedLayers, OfManySamplesTheFirstIsSeenAndCountsAreMeans) {
    const TriangleMesh<float> mesh = teapot<float>(500);
    const auto index = build_any("bvh", mesh);
    RenderOptions options;
    options.width = 40, options.height = 30, options.samples = 4, options.seed = 5;
    options.shading = Shading::normals;  // without rays to the light
    options.camera = automatic_camera(index->bounds());
    EXPECT_TRUE(render(*index, mesh, by(serial_executor(), options)).seen.empty()) << "not asked for";
    options.layers = true;
    const Picture picture = render(*index, mesh, by(default_executor(), options));

    // Make the rays of the first of four samples as the renderer does.
    std::vector<Ray3f> rays;
    const RayMaker maker(options.camera, options.width, options.height);
    for (int y = 0; y < options.height; ++y)
        for (int x = 0; x < options.width; ++x) {
            Random random(options.seed, static_cast<std::uint64_t>(y * options.width + x) * 4);
            const float dx = static_cast<float>(random.uniform()), dy = static_cast<float>(random.uniform());
            rays.push_back(maker.ray<float>(static_cast<float>(x) + dx, static_cast<float>(y) + dy));
        }
    TempFolder folder;
    save_exr(folder / "a.exr", picture.layers());
    const Read read(folder / "a.exr");
    expect_what_rays_see(read, *index, mesh, rays, false);
    // The counts of a pixel are means over its four samples.
    double nodes = 0, leaves = 0, primitives = 0;
    for (const Seen& s : picture.seen) nodes += s.nodes, leaves += s.leaves, primitives += s.primitives;
    EXPECT_EQ(picture.costs.rays, 4 * rays.size());
    EXPECT_EQ(4 * nodes, double(picture.costs.visits.nodes));
    EXPECT_EQ(4 * leaves, double(picture.costs.visits.leaves));
    EXPECT_EQ(4 * primitives, double(picture.costs.visits.primitives));
}

TEST(RenderedLayers, APictureThatIsCancelledSawNothing) {
    const TriangleMesh<float> mesh = teapot<float>(500);
    const auto index = build_any("bvh", mesh);
    RenderOptions options;
    options.width = 40, options.height = 30, options.layers = true;
    options.camera = automatic_camera(index->bounds());
    std::atomic<bool> cancelled = false;
    const Progress progress{[&](std::uint64_t done, std::uint64_t) { cancelled = done >= 10; }, &cancelled};
    const Picture picture = render(*index, mesh, by(serial_executor(), options), progress);
    for (std::size_t i = 0; i < 40 * 30; ++i) {
        const bool done = i < 40 * 16;  // rows are cast eight at a time
        EXPECT_EQ(picture.seen[i].nodes > 0, done) << i;
        EXPECT_EQ(picture.light[i] != Vec3f(), done) << i;
        if (done) continue;
        EXPECT_EQ(picture.seen[i].id, Hit<float>::none);
        EXPECT_EQ(picture.seen[i].depth, std::numeric_limits<float>::infinity());
    }
}

}  // namespace
}  // namespace hedgerow
