/// No damaged, foreign or crafted file is loaded as an index, and none does harm.
#include <csignal>

#include <sys/resource.h>

#include "../src/io/checksum.h"
#include "../src/io/index_format.h"
#include "index_files.h"

namespace hedgerow {
namespace {

using namespace testing_io;

/// Expects that loading is refused with these words in every way that verifies at least as much as `by`.
void expect_refused(const std::filesystem::path& path, const std::vector<std::string>& words,
                    Verify by = Verify::header) {
    for (const auto& way : ways_to_load)
        if (way.verify >= by) expect_input_error([&] { load_index<float>(path, way); }, words);
    if (by == Verify::header) expect_input_error([&] { index_file_info(path); }, words);
}

TEST(BadIndexFile, WithAnyByteChangedIsRefused) {
    const TempFolder folder;
    const std::string whole = small_file(folder);
    ASSERT_GT(whole.size(), 2000u);
    for (std::size_t i = 0; i < whole.size(); ++i)
        for (const int change : {0x01, 0x80, 0xFF}) {
            std::string bad = whole;
            bad[i] = static_cast<char>(bad[i] ^ change);
            const auto path = folder.file("bad.hedgerow", bad);
            const bool in_header = i < sizeof(detail::IndexHeader);
            for (const auto& way : ways_to_load)
                if (in_header || way.verify != Verify::header) {
                    ASSERT_THROW(load_index<float>(path, way), InputError) << "byte " << i;
                }
            if (in_header) {
                ASSERT_THROW(index_file_info(path), InputError) << "byte " << i;
            }
        }
}

TEST(BadIndexFile, OfAnyOtherLengthIsRefused) {
    const TempFolder folder;
    const std::string whole = small_file(folder);
    for (std::size_t size = 0; size < whole.size(); ++size) {
        const auto path = folder.file("bad.hedgerow", whole.substr(0, size));
        for (const auto& way : ways_to_load)
            ASSERT_THROW(load_index<float>(path, way), InputError) << size << " bytes";
        ASSERT_THROW(index_file_info(path), InputError) << size << " bytes";
    }
    expect_refused(folder.file("bad.hedgerow", whole.substr(0, 1000)),
                   {"bad.hedgerow", "cut off", "1000 bytes", "save it again"});
    expect_refused(folder.file("bad.hedgerow", whole.substr(0, 100)), {"cut off within its header"});
    for (const std::string& more : {std::string("x"), std::string(64, '\0'), whole})
        expect_refused(folder.file("bad.hedgerow", whole + more),
                       {"bad.hedgerow", "too long", "save it again"});
}

TEST(BadIndexFile, NamesThePlaceOfDamage) {
    const TempFolder folder;
    const auto path = folder / "large.hedgerow";
    save_index(path, built(soup<float>(40000)));
    std::string whole = contents(path);
    ASSERT_GT(whole.size(), std::size_t(3) << 20);
    whole[(std::size_t(1) << 20) + 12345] ^= 4;
    for (Executor* executor : {static_cast<Executor*>(&serial_executor()), &default_executor()})
        expect_input_error([&] { load_index<float>(folder.file("bad.hedgerow", whole), {}, *executor); },
                           {"bad.hedgerow", "bytes 1048576 to 2097151 are damaged", "save it again"});
    whole[whole.size() - 20] ^= 4;
    expect_refused(folder.file("bad.hedgerow", whole), {"the checksums from byte", "are damaged"},
                   Verify::checksums);
}

// ---- Files whose checksums are right

detail::IndexHeader header_of(const std::string& whole) {
    detail::IndexHeader header;
    std::memcpy(&header, whole.data(), sizeof header);
    return header;
}
/// A file of this header and the rest of `contents`, cut or padded with zeros to `checked` bytes, and correct
/// checksums of them.
std::string signed_file(detail::IndexHeader header, std::string contents, std::size_t checked) {
    header.checksum = detail::checksum(&header, detail::index_header_checked);
    contents.resize(checked);
    std::memcpy(contents.data(), &header, std::min(sizeof header, checked));
    detail::Checksums sums;
    sums.add(contents.data(), contents.size());
    const auto& all = sums.finish();
    std::string table;
    for (const std::uint64_t sum : all) append(table, sum, std::endian::native);
    append(table, detail::checksum(table.data(), table.size()), std::endian::native);
    return contents + table;
}
std::size_t checked_part(const std::string& whole) {
    return static_cast<std::size_t>(detail::layout_of(header_of(whole)).checksums);
}

TEST(BadIndexFile, OfAnotherKindIsRefused) {
    const TempFolder folder;
    const std::string whole = small_file(folder);
    const auto with = [&](auto change) {
        auto header = header_of(whole);
        change(header);
        return folder.file("other.hedgerow", signed_file(header, whole, checked_part(whole)));
    };
    EXPECT_EQ(load_index<float>(with([](auto&) {})).validate(), "") << "signed here, not changed";
    // Headers of other versions, byte orders, formats and scalars.
    expect_refused(with([](auto& h) { h.version = 4; }),
                   {"other.hedgerow", "version 4", "this is version 3", "save it again"});
    expect_refused(with([](auto& h) { h.byte_order = 0x04030201; }),
                   {"other.hedgerow", "byte order", "save it again"});
    expect_refused(with([](auto& h) { h.magic[0] = 'H'; }), {"other.hedgerow", "no saved index"});
    expect_refused(with([](auto& h) { h.scalar_bytes = 2; }), {"scalar of 2 bytes"});
    expect_refused(with([](auto& h) { h.scalar_bytes = 8; }), {"cut off"});
    // Indexes of the other scalar type.
    for (const auto& way : ways_to_load)
        expect_input_error([&] { load_index<double>(folder / "small.hedgerow", way); },
                           {"small.hedgerow", "holds floats", "Load it as float"});
    save_index(folder / "double.hedgerow", built(soup<double>(30)));
    expect_input_error([&] { load_index<float>(folder / "double.hedgerow"); },
                       {"holds doubles", "Load it as double"});
    // A mesh file.
    expect_refused(folder.file("other.hedgerow", "ply\nformat ascii 1.0\n" + std::string(1000, ' ')),
                   {"no saved index"});
}

TEST(BadIndexFile, WithAHeaderThatContradictsItselfIsRefused) {
    const TempFolder folder;
    const std::string whole = small_file(folder);
    const auto refused = [&](auto change, const char* word) {
        auto header = header_of(whole);
        change(header);
        expect_refused(folder.file("bad.hedgerow", signed_file(header, whole, checked_part(whole))),
                       {"bad.hedgerow", word});
    };
    using H = detail::IndexHeader;
    constexpr std::uint64_t huge = ~std::uint64_t(0);
    // Counts of 0, and counts that are too large for any file.
    for (std::uint64_t H::*count : {&H::nodes, &H::leaves, &H::triangles, &H::vertices, &H::faces})
        for (const std::uint64_t value :
             {std::uint64_t(0), huge, huge / 64, huge / 320 + 1, std::uint64_t(1) << 40})
            refused([&](H& h) { h.*count = value; }, count == &H::vertices && value == 0 ? "too long"
                                                     : count == &H::faces && value == 0
                                                         ? "too long"
                                                         : "contradicts itself");
    refused(
        [](H& h) {
            ++h.vertices;
            h.vertices += 100;
        },
        "cut off");
    // A depth, a box or options that no index has.
    refused([](H& h) { h.depth = 0; }, "contradicts itself");
    refused([](H& h) { h.depth = 100000; }, "contradicts itself");
    refused([](H& h) { h.low[1] = h.high[1] + 1; }, "contradicts itself");
    refused([](H& h) { h.high[2] = std::numeric_limits<double>::quiet_NaN(); }, "contradicts itself");
    refused([](H& h) { h.builder = 3; }, "options");
    refused([](H& h) { h.width = 5; }, "width=5");
    refused([](H& h) { h.width = 0; }, "options");
    refused([](H& h) { h.max_leaf_size = 9; }, "max_leaf_size=9");
    refused([](H& h) { h.reinsertion = huge >> 32; }, "reinsertion");
    refused([](H& h) { h.traversal_cost = -1; }, "traversal_cost");
}

/// Contents that no build makes. Each change is in the first element of a section, in the last node or in the
/// header.
TEST(BadIndexFile, WithAnUnsoundTreeOrMeshIsRefused) {
    const TempFolder folder;
    const std::string whole = small_file(folder);
    const auto header = header_of(whole);
    const auto layout = detail::layout_of(header);
    const auto refused = [&](std::uint64_t at, auto value, const char* word) {
        std::string bad = whole;
        std::memcpy(bad.data() + at, &value, sizeof value);
        expect_refused(folder.file("bad.hedgerow", signed_file(header, bad, checked_part(whole))),
                       {"bad.hedgerow", word, "save it again"}, Verify::contents);
    };
    // Change a child or a box of the root.
    const std::uint64_t children = layout.nodes + 4 * 6 * sizeof(float), counts = children + 4 * 4;
    refused(children, std::uint32_t(header.nodes), "a child that is not there");
    refused(children, std::uint32_t(0), "a child before its parent");
    refused(counts, std::uint32_t(header.triangles) + 1, "a node's count is not its children's");
    refused(children, 0x80000000u | std::uint32_t(header.leaves), "a leaf that is not there");
    refused(children, 0x80000000u | (1u << 29), "a leaf that is not there");  // times 8, this overflows to 0
    refused(children, 0xFFFFFFFFu, "an empty place before a child");
    refused(layout.nodes, std::numeric_limits<float>::infinity(), "out of its");
    // Change the count of the last node's first child. A child node comes after its parent, so the last node
    // has only leaves as children.
    std::uint64_t leaf = 0;
    const std::uint64_t last = layout.nodes + (header.nodes - 1) * WideNodes<float, 3>::stride_of(4);
    leaf = last + (counts - layout.nodes);
    refused(leaf, std::uint32_t(0), "a leaf without primitives");
    refused(leaf, std::uint32_t(9), "too many primitives");
    // Change the first item, block, vertex or triangle.
    refused(layout.items, std::uint32_t(header.triangles), "missing or held twice");
    refused(layout.items, no_primitive, "missing or held twice");
    refused(layout.blocks, 1e-3f, "other triangles");
    refused(layout.blocks + 9 * 8 * sizeof(float), std::uint32_t(12345), "other triangles");
    refused(layout.vertices, std::numeric_limits<float>::quiet_NaN(), "NaN");
    refused(layout.vertices, 1e30f, "beyond");
    refused(layout.vertices, -50.0f, "bounds");
    refused(layout.vertices, static_cast<float>(header.high[0]), "out of its leaf's box");
    refused(layout.triangles, std::uint32_t(header.vertices), "names vertex");
    // Change the header.
    auto wider = header, deeper = header;
    wider.high[0] += 1;
    expect_refused(folder.file("bad.hedgerow", signed_file(wider, whole, checked_part(whole))), {"bounds"},
                   Verify::contents);
    ++deeper.depth;
    expect_refused(folder.file("bad.hedgerow", signed_file(deeper, whole, checked_part(whole))),
                   {"not as deep"}, Verify::contents);
}

/// Expects that a crafted file is either refused or a valid index that answers. Returns whether it is an
/// index.
bool is_sound(const std::filesystem::path& path) {
    try {
        for (const bool map : {false, true}) {
            auto index = load_index<float>(path, {.map = map});
            EXPECT_EQ(index.validate(), "");
            for (int i = 0; i < 20; ++i) {
                const float x = static_cast<float>(i) / 20;
                const Ray3f ray{{x, 0.3f, -3}, {0.5f - x, 0.2f, 3}};
                const auto hit = closest_hit(index, ray);
                EXPECT_TRUE(!hit || hit.element < index.size());
                EXPECT_EQ(any_hit(index, ray), bool(hit));
            }
            index.refit();
        }
        return true;
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find(path.filename()), std::string::npos) << error.what();
        return false;
    }
}

/// Changes one to three random words of the header or of the whole file, and computes the checksums anew. The
/// file is as long as its changed header asks for, if that is less than 1 MiB.
TEST(BadIndexFile, CraftedInThousandsDoesNoHarm) {
    const TempFolder folder;
    const std::string whole = small_file(folder);
    const std::size_t checked = checked_part(whole);
    std::mt19937_64 random(11);
    const std::uint32_t words[] = {0,           1,           2,           4,           8,          16,
                                   0xFFFFFFFFu, 0x80000000u, 0x80000001u, 0x7F800000u, 0x7FC00000u};
    const int rounds = 6000;
    int sound = 0;
    for (int i = 0; i < rounds; ++i) {
        std::string bad = whole;
        const std::size_t within = i % 3 == 0 ? sizeof(detail::IndexHeader) : checked;
        // Set words to special values, or change them by at most two.
        for (std::uint64_t n = 1 + random() % 3; n > 0; --n) {
            const std::size_t at = random() % (within / 4) * 4;
            std::uint32_t word;
            std::memcpy(&word, bad.data() + at, sizeof word);
            word = random() % 2 == 0 ? words[random() % std::size(words)]
                                     : word + static_cast<std::uint32_t>(random() % 5) - 2;
            std::memcpy(bad.data() + at, &word, sizeof word);
        }
        const auto header = header_of(bad);
        const std::uint64_t asked = detail::layout_of(header).checksums;
        const std::size_t size = asked < (1u << 20) ? static_cast<std::size_t>(asked) : checked;
        sound += is_sound(folder.file("bad.hedgerow", signed_file(header, bad, size)));
    }
    EXPECT_GT(sound, 50) << "costs, and what is not used";
    EXPECT_LT(sound, rounds / 2);
}

TEST(BadIndexFile, ThatIsNoneIsRefused) {
    const TempFolder folder;
    expect_refused(folder / "missing.hedgerow", {"missing.hedgerow", "no such file"});
    expect_refused(folder / "no/such/folder.hedgerow", {"folder.hedgerow", "no such file"});
    expect_refused(folder.file("empty.hedgerow", ""), {"empty.hedgerow", "empty"});
    std::filesystem::create_directory(folder / "folder.hedgerow");
    expect_refused(folder / "folder.hedgerow", {"folder.hedgerow", "directory"});
}

// ---- Indexes of points

PointCloud<float, 3> some_points() {
    PointCloud<float, 3> cloud;
    for (int i = 0; i < 40; ++i)
        cloud.points.emplace_back(static_cast<float>(i % 7), static_cast<float>(i % 5),
                                  static_cast<float>(i));
    return cloud;
}
std::string small_file_of_points(const TempFolder& folder) {
    save_index(folder / "points.hedgerow", build<WideBvh>(some_points(), options_of(4)));
    return contents(folder / "points.hedgerow");
}

TEST(BadIndexFile, OfPointsWithAnyByteChangedOrCutIsRefused) {
    const TempFolder folder;
    const std::string whole = small_file_of_points(folder);
    for (std::size_t i = 0; i < whole.size(); ++i) {
        std::string bad = whole;
        bad[i] = static_cast<char>(bad[i] ^ 0x41);
        const auto path = folder.file("bad.hedgerow", bad);
        for (const auto& way : ways_to_load)
            if (i < sizeof(detail::IndexHeader) || way.verify != Verify::header) {
                ASSERT_THROW((load_point_index<float, 3>(path, way)), InputError) << "byte " << i;
            }
        const auto cut = folder.file("bad.hedgerow", whole.substr(0, i));
        for (const auto& way : ways_to_load)
            ASSERT_THROW((load_point_index<float, 3>(cut, way)), InputError) << i << " bytes";
    }
}

TEST(BadIndexFile, OfPointsIsNoneOfTriangles) {
    const TempFolder folder;
    small_file(folder);
    const std::string whole = small_file_of_points(folder);
    const auto points = folder / "points.hedgerow";
    for (const auto& way : ways_to_load) {
        expect_input_error([&] { load_index<float>(points, way); }, {"points.hedgerow", "holds points"});
        expect_input_error([&] { load_point_index<float, 3>(folder / "small.hedgerow", way); },
                           {"small.hedgerow", "holds triangles"});
        expect_input_error([&] { load_point_index<float, 2>(points, way); }, {"holds points in space"});
        expect_input_error([&] { load_point_index<double, 3>(points, way); }, {"holds floats"});
    }
    const auto refused = [&](auto change) {
        auto header = header_of(whole);
        change(header);
        const auto path = folder.file("bad.hedgerow", signed_file(header, whole, checked_part(whole)));
        EXPECT_THROW((load_point_index<float, 3>(path)), InputError);
        EXPECT_THROW(index_file_info(path), InputError);
    };
    refused([](auto& h) { h.kind = 2; });
    refused([](auto& h) { h.kind = 0; });
    refused([](auto& h) { h.dimension = 4; });
    refused([](auto& h) { h.dimension = 0; });
    refused([](auto& h) { h.triangles = 1; });
    refused([](auto& h) { h.faces = 1; });
    refused([](auto& h) { h.vertices = 0; });
}

TEST(BadIndexFile, OfPointsCraftedInThousandsDoesNoHarm) {
    const TempFolder folder;
    const std::string whole = small_file_of_points(folder);
    const std::size_t checked = checked_part(whole);
    std::mt19937_64 random(12);
    int sound = 0;
    for (int i = 0; i < 3000; ++i) {
        std::string bad = whole;
        const std::size_t within = i % 3 == 0 ? sizeof(detail::IndexHeader) : checked;
        for (std::uint64_t n = 1 + random() % 3; n > 0; --n) {
            const std::size_t at = random() % (within / 4) * 4;
            std::uint32_t word;
            std::memcpy(&word, bad.data() + at, sizeof word);
            word = random() % 3 == 0 ? static_cast<std::uint32_t>(random())
                                     : word + static_cast<std::uint32_t>(random() % 5) - 2;
            std::memcpy(bad.data() + at, &word, sizeof word);
        }
        const auto header = header_of(bad);
        const std::uint64_t asked = detail::layout_of(header).checksums;
        const std::size_t size = asked < (1u << 20) ? static_cast<std::size_t>(asked) : checked;
        const auto path = folder.file("bad.hedgerow", signed_file(header, bad, size));
        try {
            auto index = load_point_index<float, 3>(path);
            EXPECT_EQ(index.validate(), "");
            for (int k = 0; k < 20; ++k)
                EXPECT_LT(closest_point(index, Vec3f::all(static_cast<float>(k))).element, index.size());
            EXPECT_EQ(overlap_count(index, index.bounds()), index.size());
            index.refit();
            ++sound;
        } catch (const InputError&) {
        }
    }
    EXPECT_GT(sound, 10) << "costs, and what is not used";
    EXPECT_LT(sound, 1500);
}

/// Limits the size of files that this process writes, as if the disk were full, and removes the limit at its
/// end.
class LittleRoom {
public:
    explicit LittleRoom(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
        getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit little{bytes, before_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &little);
    }
    ~LittleRoom() {
        setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }
    LittleRoom(const LittleRoom&) = delete;
    LittleRoom& operator=(const LittleRoom&) = delete;

private:
    void (*handler_)(int);
    rlimit before_{};
};

TEST(BadIndexFile, ThatCannotBeWrittenLeavesNothingBehind) {
    const TempFolder folder;
    const auto index = built(soup<float>(3000));
    expect_output_error([&] { save_index(folder / "no/such.hedgerow", index); },
                        {"such.hedgerow", "cannot be written"});
    std::filesystem::create_directory(folder / "folder.hedgerow");
    expect_output_error([&] { save_index(folder / "folder.hedgerow", index); },
                        {"folder.hedgerow", "directory"});
    if (std::filesystem::exists("/dev/full"))
        expect_output_error([&] { save_index("/dev/full", index); }, {"/dev/full", "No space left"});
    {
        const LittleRoom room(100000);
        expect_output_error([&] { save_index(folder / "large.hedgerow", index); },
                            {"large.hedgerow", "cannot be written", "space left"});
    }
    EXPECT_EQ(folder.file_count(), 1u);
}

}  // namespace
}  // namespace hedgerow
