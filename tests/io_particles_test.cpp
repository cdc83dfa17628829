/// Particles and states of motions from and to files of rows.
#include <gtest/gtest.h>

#include <filesystem>

#include <hedgerow/base/error.h>
#include <hedgerow/io/particle_file.h>
#include <hedgerow/io/point_file.h>
#include <hedgerow/nbody/motion.h>
#include <hedgerow/scenes/particles.h>

#include "io_support.h"

using namespace hedgerow;

namespace {

constexpr bool has_hdf5 = HEDGEROW_HAS_HDF5;

using testing_io::TempFolder;

TEST(ParticleFile, KeepsAStateToTheLastBit) {
    const TempFolder folder;
    Motion motion(plummer(1000), {.softening = {.length = 0.1}});
    motion.step(0.3);
    const MotionState& state = motion.state();
    for (const char* name : {"a.npy", "a.csv", "a.json", "a.hdf5", "a.h5"}) {
        if (!has_hdf5 && std::string(name).find(".h") != std::string::npos) continue;
        save_state(folder / name, state);
        const MotionState read = load_state(folder / name);
        EXPECT_EQ(read.time, state.time) << name;
        EXPECT_EQ(read.particles.places, state.particles.places) << name;
        EXPECT_EQ(read.particles.velocities, state.particles.velocities) << name;
        EXPECT_EQ(read.particles.masses, state.particles.masses) << name;
        EXPECT_EQ(read.accelerations, state.accelerations) << name;
        EXPECT_EQ(read.potentials, state.potentials) << name;
    }
}
TEST(ParticleFile, MayHaveFewerColumns) {
    const TempFolder folder;
    const MotionState places = load_state(folder.file("places.csv", "x,y,z\n1,2,3\n4,5,6\n"));
    EXPECT_EQ(places.particles.places[1], Vec3d(4, 5, 6));
    EXPECT_EQ(places.particles.velocities[1], Vec3d());
    EXPECT_EQ(places.particles.masses, (std::vector{0.5, 0.5}));
    EXPECT_TRUE(places.accelerations.empty());
    const MotionState heavy = load_state(folder.file("heavy.csv", "mass,x,y,z\n7,1,2,3\n"));
    EXPECT_EQ(heavy.particles.masses, (std::vector{7.0}));
    EXPECT_EQ(heavy.particles.places[0], Vec3d(1, 2, 3));
    const MotionState moving = load_state(folder.file("moving.csv", "1 2 3 0.1 0.2 0.3 7\n"));
    EXPECT_EQ(moving.particles.velocities[0], Vec3d(0.1, 0.2, 0.3));
    EXPECT_EQ(moving.particles.masses, (std::vector{7.0}));
    const PointCloud<double, 3> cloud{{{1, 2, 3}, {3, 4, 5}}};
    save_points(folder / "cloud.ply", cloud);
    EXPECT_EQ(load_state(folder / "cloud.ply").particles.places, cloud.points);
    save_points(folder / "cloud.npy", cloud);
    EXPECT_EQ(load_state(folder / "cloud.npy").particles.places, cloud.points);
    EXPECT_EQ(load_state(folder.file("none.csv", "x,y,z\n")).particles.size(), 0u);
}
TEST(ParticleFile, RefusesBadInput) {
    const TempFolder folder;
    EXPECT_THROW(load_state(folder.file("bad.csv", "x,y\n1,2\n")), InputError);
    EXPECT_THROW(load_state(folder.file("short.csv", "x,y,z\n1,2\n")), InputError);
    EXPECT_THROW(load_state(folder / "missing.npy"), InputError);
    EXPECT_THROW(load_state(folder.file("times.csv", "1 2 3 0 0 0 1 0 0 0 0 5\n1 2 3 0 0 0 1 0 0 0 0 6\n")),
                 InputError);
    EXPECT_THROW(load_state(folder.file("speed.csv", "1 2 3 0 inf 0 1\n")), InputError);
    EXPECT_THROW(load_state(folder.file("mass.csv", "x,y,z,mass\n1,2,3,nan\n")), InputError);
    EXPECT_THROW(load_state(folder.file("far.xyz", "1 2 3\n1e200 0 0\n")), InputError);
    EXPECT_THROW(load_state(folder.file("force.csv", "1 2 3 0 0 0 1 0 0 nan 0 5\n")), InputError);
    EXPECT_THROW(load_state(folder.file("time.csv", "1 2 3 0 0 0 1 0 0 0 0 inf\n")), InputError);
    // A bad number is none of a file with fewer columns.
    const std::string named = "x,y,z,vx,vy,vz,mass\n0,0,0,0,0,0,5\n";
    for (const std::string& text : {named + "1,0,0,0,1,0,abc\n", named + "1,0,0,0,1,0,\n",
                                    std::string("1 2 3 0 0 0 1\n1 2 3 0 0 x 1\n")})
        try {
            load_state(folder.file("number.csv", text));
            FAIL() << text;
        } catch (const InputError& fault) {
            EXPECT_NE(std::string(fault.what()).find("where a number should stand"), std::string::npos)
                << fault.what();
        }
    EXPECT_THROW(load_state(folder.file("text.json", R"({"x":1,"y":2,"z":3,"mass":"7"})")), InputError);
    EXPECT_THROW(save_state(folder / "a.npy", load_state(folder.file("at.csv", "x,y,z\n1,2,3\n"))),
                 InputError);
    EXPECT_THROW(save_state(folder / "a.npy.gz", Motion(plummer(10)).state()), UsageError);
    MotionState state;
    EXPECT_THROW(save_state(folder / "a.xyz", state), UsageError);
    EXPECT_THROW(save_state(folder / "no/a.npy", state), OutputError);
    // A snapshot that is cut short.
    state = Motion(plummer(100)).state();
    save_state(folder / "a.npy", state);
    std::filesystem::resize_file(folder / "a.npy", std::filesystem::file_size(folder / "a.npy") - 1);
    EXPECT_THROW(load_state(folder / "a.npy"), InputError);
}

// ---- HDF5 in GADGET's layout

/// Runs a program of Python's on a file. Skips the test where Python lacks a module that it uses.
#define EXPECT_PYTHON(module, program, path)                                                                 \
    do {                                                                                                     \
        if (std::system("/usr/bin/python3 -c 'import " module "' 2>/dev/null") != 0)                         \
            GTEST_SKIP() << "no Python with the module " module;                                             \
        std::ofstream(folder / "read.py") << (program);                                                      \
        EXPECT_EQ(std::system(("/usr/bin/python3 " + (folder / "read.py").string() + " " + (path)).c_str()), \
                  0);                                                                                        \
    } while (false)

MotionState moved() {
    Motion motion(plummer(500), {.softening = {.length = 0.1}});
    motion.step(0.25);
    return motion.state();
}
TEST(Gadget, H5pyReadsWhatIsSaved) {
    if (!has_hdf5) GTEST_SKIP() << "no HDF5";
    const TempFolder folder;
    const MotionState state = moved();
    save_state(folder / "a.hdf5", state, 3);
    std::ofstream(folder / "want.txt") << std::hexfloat << state.particles.places[7][1] << "\n"
                                       << state.particles.masses[3] << "\n"
                                       << state.potentials[499] << "\n";
    EXPECT_PYTHON("h5py", R"(
import h5py, sys
want = [float.fromhex(line) for line in open(sys.argv[1].replace('a.hdf5', 'want.txt'))]
with h5py.File(sys.argv[1]) as f:
    header, stars = f['Header'].attrs, f['PartType1']
    assert list(header['NumPart_ThisFile']) == [0, 500, 0, 0, 0, 0]
    assert list(header['NumPart_Total']) == [0, 500, 0, 0, 0, 0]
    assert header['Time'] == 0.25 and header['BoxSize'] == 3 and header['NumFilesPerSnapshot'] == 1
    assert stars['Coordinates'].shape == stars['Velocities'].shape == stars['Acceleration'].shape == (500, 3)
    assert stars['Coordinates'].dtype == 'f8' and stars['ParticleIDs'].dtype.kind == 'u'
    assert len(set(stars['ParticleIDs'])) == 500
    assert [stars['Coordinates'][7, 1], stars['Masses'][3], stars['Potential'][499]] == want
)",
                  (folder / "a.hdf5").string());
}
TEST(Gadget, YtReadsWhatIsSaved) {
    if (!has_hdf5) GTEST_SKIP() << "no HDF5";
    const TempFolder folder;
    save_state(folder / "a.hdf5", moved());
    EXPECT_PYTHON("yt", R"(
import yt, sys
yt.set_log_level(50)
snapshot = yt.load(sys.argv[1], bounding_box=[[-100, 100]] * 3)
everything = snapshot.all_data()
assert len(everything['PartType1', 'Masses']) == 500
assert abs(float(everything['PartType1', 'Masses'].sum().in_units('code_mass')) - 1) < 1e-12
assert abs(float(snapshot.current_time.in_units('code_time')) - 0.25) < 1e-12
)",
                  (folder / "a.hdf5").string());
}
/// As other codes write them: single precision, several types of particles, masses in the table.
TEST(Gadget, SnapshotsOfOthersAreRead) {
    if (!has_hdf5) GTEST_SKIP() << "no HDF5";
    const TempFolder folder;
    EXPECT_PYTHON("h5py", R"(
import h5py, sys
with h5py.File(sys.argv[1], 'w') as f:
    header = f.create_group('Header').attrs
    header['NumPart_ThisFile'] = [0, 2, 0, 0, 1, 0]
    header['MassTable'] = [0, 0.5, 0, 0, 0, 0]
    header['NumFilesPerSnapshot'] = 1
    header['Time'] = 1.5
    halo, stars = f.create_group('PartType1'), f.create_group('PartType4')
    halo.create_dataset('Coordinates', data=[[1, 2, 3], [4, 5, 6]], dtype='f4')
    halo.create_dataset('Velocities', data=[[0, 0, 1], [0, 1, 0]], dtype='f4', chunks=(1, 3), compression='gzip')
    stars.create_dataset('Coordinates', data=[[7, 8, 9]], dtype='f8')
    stars.create_dataset('Velocities', data=[[0, 0, 0]], dtype='f8')
    stars.create_dataset('Masses', data=[2], dtype='f8')
)",
                  (folder / "a.hdf5").string());
    const MotionState state = load_state(folder / "a.hdf5");
    EXPECT_EQ(state.time, 1.5);
    EXPECT_EQ(state.particles.places, (std::vector<Vec3d>{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}));
    EXPECT_EQ(state.particles.velocities[1], Vec3d(0, 1, 0));
    EXPECT_EQ(state.particles.masses, (std::vector{0.5, 0.5, 2.0}));
    EXPECT_TRUE(state.accelerations.empty());
}
/// Snapshots in several files, with SWIFT's seven types and masses of black holes.
TEST(Gadget, SeveralFilesAreOneSnapshot) {
    if (!has_hdf5) GTEST_SKIP() << "no HDF5";
    const TempFolder folder;
    EXPECT_PYTHON("h5py", R"(
import h5py, sys
for part in range(2):
    with h5py.File(sys.argv[1].replace('.0.', '.%d.' % part), 'w') as f:
        header = f.create_group('Header').attrs
        header['NumPart_ThisFile'] = [1, 0, 0, 0, 0, part, 0]
        header['MassTable'] = [0, 0, 0, 0, 0, 0, 0]
        header['NumFilesPerSnapshot'] = [2]
        header['Time'] = [1.5]
        gas = f.create_group('PartType0')
        gas.create_dataset('Coordinates', data=[[part, 2, 3]], dtype='f8')
        gas.create_dataset('Velocities', data=[[0, 0, 1]], dtype='f4')
        gas.create_dataset('Masses', data=[1 + part], dtype='f4')
        if part:
            hole = f.create_group('PartType5')
            hole.create_dataset('Coordinates', data=[[7, 8, 9]], dtype='f8')
            hole.create_dataset('Velocities', data=[[0, 0, 0]], dtype='f4')
            hole.create_dataset('DynamicalMasses', data=[5], dtype='f4')
)",
                  (folder / "a.0.hdf5").string());
    for (const char* name : {"a.0.hdf5", "a.1.hdf5"}) {
        const MotionState state = load_state(folder / name);
        EXPECT_EQ(state.time, 1.5);
        EXPECT_EQ(state.particles.places, (std::vector<Vec3d>{{0, 2, 3}, {1, 2, 3}, {7, 8, 9}}));
        EXPECT_EQ(state.particles.masses, (std::vector{1.0, 2.0, 5.0}));
    }
    std::filesystem::remove(folder / "a.1.hdf5");
    testing_io::expect_input_error([&] { load_state(folder / "a.0.hdf5"); }, {"a.1.hdf5", "no such file"});
    std::filesystem::rename(folder / "a.0.hdf5", folder / "b.hdf5");
    testing_io::expect_input_error([&] { load_state(folder / "b.hdf5"); }, {"NAME.0.hdf5"});
}
TEST(Gadget, ParticlesWithoutMassesAreRefused) {
    if (!has_hdf5) GTEST_SKIP() << "no HDF5";
    const TempFolder folder;
    EXPECT_PYTHON("h5py", R"(
import h5py, sys
with h5py.File(sys.argv[1], 'w') as f:
    header = f.create_group('Header').attrs
    header['NumPart_ThisFile'] = [0, 2, 0, 0, 0, 0]
    header['MassTable'] = [1, 0, 0, 0, 0, 0]
    header['NumFilesPerSnapshot'] = 1
    header['Time'] = 0
    halo = f.create_group('PartType1')
    halo.create_dataset('Coordinates', data=[[1, 2, 3], [4, 5, 6]])
    halo.create_dataset('Velocities', data=[[0, 0, 1], [0, 1, 0]])
)",
                  (folder / "a.hdf5").string());
    testing_io::expect_input_error([&] { load_state(folder / "a.hdf5"); },
                                   {"PartType1", "no masses", "MassTable"});
}
TEST(Gadget, RefusesBadFiles) {
    if (!has_hdf5) {
        EXPECT_THROW(save_state("a.hdf5", MotionState()), UsageError);
        GTEST_SKIP() << "no HDF5";
    }
    const TempFolder folder;
    EXPECT_THROW(load_state(folder / "missing.hdf5"), InputError);
    EXPECT_THROW(load_state(folder.file("text.hdf5", "x,y,z\n1,2,3\n")), InputError);
    EXPECT_THROW(save_state(folder / "no/a.hdf5", moved()), OutputError);
    // Cut short anywhere.
    save_state(folder / "a.hdf5", moved());
    const std::string whole = testing_io::contents(folder / "a.hdf5");
    for (std::size_t size = 0; size < whole.size(); size += 997)
        EXPECT_THROW(load_state(folder.file("b.hdf5", whole.substr(0, size))), InputError) << size;
    // None are a snapshot too.
    save_state(folder / "none.hdf5", MotionState());
    EXPECT_EQ(load_state(folder / "none.hdf5").particles.size(), 0u);
    EXPECT_PYTHON("h5py", R"(
import h5py, sys
for name, change in {
    'other': lambda f: f.__delitem__('Header'),
    'parts': lambda f: f['Header'].attrs.__setitem__('NumFilesPerSnapshot', 4),
    'rows': lambda f: f['Header'].attrs.__setitem__('NumPart_ThisFile', [0, 501, 0, 0, 0, 0]),
    'less': lambda f: f['PartType1'].__delitem__('Velocities'),
    'words': lambda f: f['Header'].attrs.__setitem__('Time', 'noon'),
    'huge': lambda f: (f['PartType1'].__delitem__('Masses'), f['PartType1'].create_dataset('Masses', (1 << 40,), 'f8', chunks=(1,))),
}.items():
    path = sys.argv[1].replace('a.hdf5', name + '.hdf5')
    open(path, 'wb').write(open(sys.argv[1], 'rb').read())
    with h5py.File(path, 'r+') as f: change(f)
)",
                  (folder / "a.hdf5").string());
    for (const char* name : {"other", "parts", "rows", "less", "words", "huge"})
        EXPECT_THROW(load_state(folder / (std::string(name) + ".hdf5")), InputError) << name;
}

}  // namespace
