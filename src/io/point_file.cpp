/// Chooses the reader and the writer of points by the extension.
#include <hedgerow/io/point_file.h>

#include <hedgerow/base/error.h>
#include <hedgerow/io/validate.h>

#include "memory.h"
#include "npy_format.h"
#include "output_file.h"
#include "readers.h"
#include "text.h"

namespace hedgerow {

namespace detail {

template <class T, int D>
PointCloud<T, D> read_npy_points(ByteSource& file) {
    const NpyArray array = read_npy(file);
    if (array.shape.size() != 2 || array.shape[1] != D) {
        std::string shape;
        for (const std::size_t n : array.shape) shape += (shape.empty() ? "" : ", ") + std::to_string(n);
        file.fail("the array has shape (" + shape + "), but points in " + std::to_string(D) + "D are (N, " +
                  std::to_string(D) + "). Reshape it, or load it with another dimension");
    }
    expect_memory(file.name(), "its " + std::to_string(array.size()) + " numbers",
                  2 * array.size() * sizeof(T));
    const std::vector<T> values = array.as<T>();
    PointCloud<T, D> cloud;
    cloud.points.resize(array.shape[0]);
    for (std::size_t i = 0; i < values.size(); ++i) cloud.points[i / D][static_cast<int>(i % D)] = values[i];
    return cloud;
}

namespace {

[[noreturn]] void fail_unknown_points(const std::filesystem::path& path, const char* known) {
    throw InputError(path.string() + ": the extension " + shown(path.extension().string()) +
                     " is not known for points. Known are " + known);
}

template <class T, int D>
void write_ply_points(OutputFile& file, const PointCloud<T, D>& cloud) {
    const std::string type = std::is_same_v<T, float> ? "float" : "double";
    std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex ";
    header += std::to_string(cloud.size()) + "\n";
    for (const char axis : {'x', 'y', 'z'}) header += "property " + type + " " + axis + "\n";
    file.write(header + "end_header\n");
    for (const Vec<T, D>& p : cloud.points) {
        for (int i = 0; i < 3; ++i) file.little(i < D ? p[i] : T(0));
        file.advance();
    }
}

template <class T, int D>
void write_npy_points(OutputFile& file, const PointCloud<T, D>& cloud) {
    file.write(npy_header(npy_dtype<T>(), {cloud.size(), D}));
    for (const Vec<T, D>& p : cloud.points) {
        for (int i = 0; i < D; ++i) file.little(p[i]);
        file.advance();
    }
}

template <class T, int D>
void write_lines(OutputFile& file, const PointCloud<T, D>& cloud, char separator) {
    std::string line;
    for (const Vec<T, D>& p : cloud.points) {
        line.clear();
        for (int i = 0; i < D; ++i) {
            if (i > 0) line += separator;
            append_number(line, p[i]);
        }
        file.write(line += '\n');
        file.advance();
    }
}

template <class T, int D>
void write_csv_points(OutputFile& file, const PointCloud<T, D>& cloud) {
    file.write(D == 2 ? "x,y\n" : "x,y,z\n");
    write_lines(file, cloud, ',');
}

template <class T, int D>
void write_xyz_points(OutputFile& file, const PointCloud<T, D>& cloud) {
    write_lines(file, cloud, ' ');
}

}  // namespace
}  // namespace detail

template <class T, int D>
PointCloud<T, D> load_points(const std::filesystem::path& path, const LoadOptions& options,
                             const Progress& progress) {
    const std::string format = detail::format_of(path);
    PointCloud<T, D> (*read)(detail::ByteSource&) = nullptr;
    if (format == ".ply") read = detail::read_ply_points<T, D>;
    if (format == ".npy") read = detail::read_npy_points<T, D>;
    if (format == ".csv") read = detail::read_csv_points<T, D>;
    if (format == ".xyz") read = detail::read_xyz_points<T, D>;
    if (read == nullptr) {
        detail::check_readable(path);
        detail::fail_unknown_points(path, ".ply .npy .csv .xyz, each also with .gz");
    }
    return detail::within_memory(path, [&] {
        detail::ByteSource file(path, progress);
        return validated(read(file), path.string(), options);
    });
}

template <class T, int D>
void save_points(const std::filesystem::path& path, const PointCloud<T, D>& cloud, const Progress& progress) {
    const std::string extension = detail::lower_case(path.extension().string());
    void (*write)(detail::OutputFile&, const PointCloud<T, D>&) = nullptr;
    if (extension == ".ply") write = detail::write_ply_points;
    if (extension == ".npy") write = detail::write_npy_points;
    if (extension == ".csv") write = detail::write_csv_points;
    if (extension == ".xyz") write = detail::write_xyz_points;
    if (write == nullptr) detail::fail_unknown_points(path, ".ply .npy .csv .xyz");
    detail::OutputFile file(path, progress);
    file.expect(cloud.size());
    write(file, cloud);
    file.commit();
}

using Path = std::filesystem::path;
template PointCloud<float, 2> load_points(const Path&, const LoadOptions&, const Progress&);
template PointCloud<float, 3> load_points(const Path&, const LoadOptions&, const Progress&);
template PointCloud<double, 2> load_points(const Path&, const LoadOptions&, const Progress&);
template PointCloud<double, 3> load_points(const Path&, const LoadOptions&, const Progress&);
template void save_points(const Path&, const PointCloud<float, 2>&, const Progress&);
template void save_points(const Path&, const PointCloud<float, 3>&, const Progress&);
template void save_points(const Path&, const PointCloud<double, 2>&, const Progress&);
template void save_points(const Path&, const PointCloud<double, 3>&, const Progress&);

}  // namespace hedgerow
