/// The memory that control groups leave to a process, read from files like those of the system.
#include "../src/io/memory.h"
#include "io_support.h"

namespace hedgerow {
namespace {

using testing_io::TempFolder;
constexpr std::uint64_t unlimited = ~std::uint64_t(0);

/// A folder in place of /sys/fs/cgroup, and beside it a file in place of /proc/self/cgroup.
class Groups {
public:
    void set(const std::string& group, const std::string& file, const std::string& text) const {
        std::filesystem::create_directories(folder_ / ("mounted/" + group));
        folder_.file("mounted/" + group + "/" + file, text + "\n");
    }
    std::uint64_t left(const std::string& list) const {
        return detail::memory_left_to_group(folder_.file("cgroup", list), folder_ / "mounted");
    }

private:
    TempFolder folder_;
};

TEST(MemoryOfGroups, OfVersion2IsTheLeastOnTheWayUp) {
    const Groups groups;
    const std::string list = "0::/a/b/c\n";
    EXPECT_EQ(groups.left(list), unlimited) << "nothing is mounted";
    groups.set("a/b/c", "memory.max", "max");
    EXPECT_EQ(groups.left(list), unlimited);
    groups.set("a/b", "memory.max", "1000");
    groups.set("a/b", "memory.current", "300");
    EXPECT_EQ(groups.left(list), 700u);
    groups.set("a", "memory.max", "600");
    groups.set("a", "memory.current", "500");
    EXPECT_EQ(groups.left(list), 100u);
    groups.set("a", "memory.stat", "anon 400\nactive_file 7\ninactive_file 60\n");
    EXPECT_EQ(groups.left(list), 160u) << "cached files can be freed";
    EXPECT_EQ(groups.left("0::/other\n"), unlimited);
    groups.set("a/b/c", "memory.max", "200");
    groups.set("a/b/c", "memory.current", "250");
    EXPECT_EQ(groups.left(list), 0u);
}

TEST(MemoryOfGroups, OfVersion1IsThatOfItsControllerOfMemory) {
    const Groups groups;
    const std::string list = "5:cpu,cpuacct:/\n4:blkio,memory:/jobs/7\n1:name=systemd:/\n0::/\n";
    groups.set("memory", "memory.limit_in_bytes", "9223372036854771712");
    groups.set("memory", "memory.usage_in_bytes", "12712");
    EXPECT_EQ(groups.left(list), 9223372036854759000u);
    groups.set("memory/jobs/7", "memory.limit_in_bytes", "4000");
    groups.set("memory/jobs/7", "memory.usage_in_bytes", "3000");
    groups.set("memory/jobs/7", "memory.stat", "inactive_file 1\ntotal_inactive_file 20\n");
    EXPECT_EQ(groups.left(list), 1020u);
    groups.set("unified", "memory.max", "900");
    EXPECT_EQ(groups.left(list), 900u) << "both versions at once";
}

TEST(MemoryOfGroups, InAContainerIsThatOfTheRoot) {
    const Groups groups;
    groups.set("", "memory.max", "5000");
    groups.set("", "memory.current", "1000");
    for (const char* list : {"0::/made/by/the/host\n", "0::/../../elsewhere\n", "0::/\n"})
        EXPECT_EQ(groups.left(list), 4000u) << list;
}

}  // namespace
}  // namespace hedgerow
