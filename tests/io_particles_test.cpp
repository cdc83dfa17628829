/// Particles and states of motions from and to files of rows.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include <hedgerow/base/error.h>
#include <hedgerow/io/particle_file.h>
#include <hedgerow/io/point_file.h>
#include <hedgerow/nbody/motion.h>
#include <hedgerow/scenes/particles.h>

using namespace hedgerow;

namespace {

class ParticleFile : public testing::Test {
protected:
    std::filesystem::path folder_ = testing::TempDir() + "/hedgerow_particles";
    void SetUp() override { std::filesystem::create_directories(folder_); }
    void TearDown() override { std::filesystem::remove_all(folder_); }
    std::filesystem::path written(const char* name, const char* text) {
        std::ofstream(folder_ / name) << text;
        return folder_ / name;
    }
};

TEST_F(ParticleFile, KeepsAStateToTheLastBit) {
    Motion motion(plummer(1000), {.softening = {.length = 0.1}});
    motion.step(0.3);
    const MotionState& state = motion.state();
    for (const char* name : {"a.npy", "a.csv", "a.json"}) {
        save_state(folder_ / name, state);
        const MotionState read = load_state(folder_ / name);
        EXPECT_EQ(read.time, state.time) << name;
        EXPECT_EQ(read.particles.places, state.particles.places) << name;
        EXPECT_EQ(read.particles.velocities, state.particles.velocities) << name;
        EXPECT_EQ(read.particles.masses, state.particles.masses) << name;
        EXPECT_EQ(read.accelerations, state.accelerations) << name;
        EXPECT_EQ(read.potentials, state.potentials) << name;
    }
}
TEST_F(ParticleFile, MayHaveFewerColumns) {
    const MotionState places = load_state(written("places.csv", "x,y,z\n1,2,3\n4,5,6\n"));
    EXPECT_EQ(places.particles.places[1], Vec3d(4, 5, 6));
    EXPECT_EQ(places.particles.velocities[1], Vec3d());
    EXPECT_EQ(places.particles.masses, (std::vector{0.5, 0.5}));
    EXPECT_TRUE(places.accelerations.empty());
    const MotionState heavy = load_state(written("heavy.csv", "mass,x,y,z\n7,1,2,3\n"));
    EXPECT_EQ(heavy.particles.masses, (std::vector{7.0}));
    EXPECT_EQ(heavy.particles.places[0], Vec3d(1, 2, 3));
    const MotionState moving = load_state(written("moving.csv", "1 2 3 0.1 0.2 0.3 7\n"));
    EXPECT_EQ(moving.particles.velocities[0], Vec3d(0.1, 0.2, 0.3));
    EXPECT_EQ(moving.particles.masses, (std::vector{7.0}));
    const PointCloud<double, 3> cloud{{{1, 2, 3}, {3, 4, 5}}};
    save_points(folder_ / "cloud.ply", cloud);
    EXPECT_EQ(load_state(folder_ / "cloud.ply").particles.places, cloud.points);
    save_points(folder_ / "cloud.npy", cloud);
    EXPECT_EQ(load_state(folder_ / "cloud.npy").particles.places, cloud.points);
    EXPECT_EQ(load_state(written("none.csv", "x,y,z\n")).particles.size(), 0u);
}
TEST_F(ParticleFile, RefusesBadInput) {
    EXPECT_THROW(load_state(written("bad.csv", "x,y\n1,2\n")), InputError);
    EXPECT_THROW(load_state(written("short.csv", "x,y,z\n1,2\n")), InputError);
    EXPECT_THROW(load_state(folder_ / "missing.npy"), InputError);
    EXPECT_THROW(load_state(written("times.csv", "1 2 3 0 0 0 1 0 0 0 0 5\n1 2 3 0 0 0 1 0 0 0 0 6\n")),
                 InputError);
    MotionState state;
    EXPECT_THROW(save_state(folder_ / "a.xyz", state), UsageError);
    EXPECT_THROW(save_state(folder_ / "no/a.npy", state), OutputError);
    // A snapshot that is cut short.
    state = Motion(plummer(100)).state();
    save_state(folder_ / "a.npy", state);
    std::filesystem::resize_file(folder_ / "a.npy", std::filesystem::file_size(folder_ / "a.npy") - 1);
    EXPECT_THROW(load_state(folder_ / "a.npy"), InputError);
}

}  // namespace
