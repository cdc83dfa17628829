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

using testing_io::TempFolder;

TEST(ParticleFile, KeepsAStateToTheLastBit) {
    const TempFolder folder;
    Motion motion(plummer(1000), {.softening = {.length = 0.1}});
    motion.step(0.3);
    const MotionState& state = motion.state();
    for (const char* name : {"a.npy", "a.csv", "a.json"}) {
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
    MotionState state;
    EXPECT_THROW(save_state(folder / "a.xyz", state), UsageError);
    EXPECT_THROW(save_state(folder / "no/a.npy", state), OutputError);
    // A snapshot that is cut short.
    state = Motion(plummer(100)).state();
    save_state(folder / "a.npy", state);
    std::filesystem::resize_file(folder / "a.npy", std::filesystem::file_size(folder / "a.npy") - 1);
    EXPECT_THROW(load_state(folder / "a.npy"), InputError);
}

}  // namespace
