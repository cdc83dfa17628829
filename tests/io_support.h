/// Helpers for tests of files: temporary folders, files from text, and expected errors.
#pragma once

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include <hedgerow/base/error.h>
#include <hedgerow/io/mesh_file.h>

namespace hedgerow::testing_io {

/// A new temporary folder. The destructor removes it and all that is in it.
class TempFolder {
public:
    TempFolder() {
        std::random_device random;
        do {
            path_ = std::filesystem::temp_directory_path() /
                    ("hedgerow-io-" + std::to_string(random()) + std::to_string(random()));
        } while (!std::filesystem::create_directory(path_));
    }
    ~TempFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TempFolder(const TempFolder&) = delete;
    TempFolder& operator=(const TempFolder&) = delete;

    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    std::filesystem::path file(const std::string& name, const std::string& bytes) const {
        // Remove the file first: some file systems flush a file that is truncated and written.
        std::filesystem::remove(path_ / name);
        std::ofstream(path_ / name, std::ios::binary) << bytes;
        return path_ / name;
    }
    std::size_t file_count() const {
        return static_cast<std::size_t>(
            std::distance(std::filesystem::directory_iterator(path_), std::filesystem::directory_iterator()));
    }

private:
    std::filesystem::path path_;
};

inline std::string contents(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

inline void gzip(const std::filesystem::path& path, const std::string& bytes) {
    gzFile file = gzopen(path.c_str(), "wb");
    gzwrite(file, bytes.data(), static_cast<unsigned>(bytes.size()));
    gzclose(file);
}

template <class U>
void append(std::string& bytes, U value, std::endian order = std::endian::little) {
    char raw[sizeof(U)];
    std::memcpy(raw, &value, sizeof(U));
    if (order != std::endian::native) std::reverse(raw, raw + sizeof(U));
    bytes.append(raw, sizeof(U));
}

/// Expects that f throws an E whose message contains all the parts.
template <class E, class F>
void expect_error(F f, const std::vector<std::string>& parts) {
    try {
        f();
    } catch (const E& error) {
        for (const std::string& part : parts)
            EXPECT_NE(std::string(error.what()).find(part), std::string::npos)
                << "no \"" << part << "\" in: " << error.what();
        return;
    }
    ADD_FAILURE() << "no error with \"" << parts.front() << "\"";
}
template <class F>
void expect_input_error(F f, const std::vector<std::string>& parts) {
    expect_error<InputError>(f, parts);
}
template <class F>
void expect_output_error(F f, const std::vector<std::string>& parts) {
    expect_error<OutputError>(f, parts);
}

/// A random coordinate of any magnitude that is allowed, at times 0, −0 or subnormal.
template <class T>
T random_coordinate(std::mt19937_64& random) {
    if (random() % 16 == 0) return random() % 2 == 0 ? T(0) : -T(0);
    const int most = std::is_same_v<T, float> ? 59 : 479;
    const int least = std::is_same_v<T, float> ? -149 : -1074;
    const int exponent = least + static_cast<int>(random() % static_cast<std::uint64_t>(most - least));
    const T unit = static_cast<T>(std::uniform_real_distribution<double>(-1, 1)(random));
    return std::ldexp(unit, exponent);
}

template <class T>
TriangleMesh<T> random_mesh(std::mt19937_64& random) {
    TriangleMesh<T> mesh;
    mesh.vertices.resize(3 + random() % 40);
    for (auto& v : mesh.vertices)
        for (int i = 0; i < 3; ++i) v[i] = random_coordinate<T>(random);
    mesh.triangles.resize(1 + random() % 60);
    for (auto& t : mesh.triangles)
        for (auto& v : t) v = static_cast<std::uint32_t>(random() % mesh.vertices.size());
    return mesh;
}

/// Whether two arrays have equal bits. −0 differs from 0.
template <class V>
bool same_bits(const V& a, const V& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
}

}  // namespace hedgerow::testing_io
