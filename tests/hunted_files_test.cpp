/// A short hunt for texts that mean the same and are read as something else.
#include <gtest/gtest.h>

#include "hunter/report.h"

namespace hedgerow::hunter {
namespace {

TEST(HuntedFiles, EveryStyleGivesTheSameGeometry) {
    std::uint64_t texts = 0;
    for (std::uint64_t round = 0; round < 250; ++round) {
        const Report report = hunt_files(1, round);
        texts += report.questions;
        for (const auto& entry : report.found) ADD_FAILURE() << entry;
    }
    EXPECT_EQ(texts, 2000u);
}

}  // namespace
}  // namespace hedgerow::hunter
