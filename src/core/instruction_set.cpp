/// Which instruction sets this processor and this build have, and which is in use.
#include <hedgerow/base/instruction_set.h>

#include <atomic>
#include <cstdlib>
#include <string>

#include <hedgerow/base/error.h>

#if HEDGEROW_HAS_HIGHWAY
#include "targets.h"
// Must come after targets.h.
#include <hwy/detect_targets.h>
#endif

namespace hedgerow {
namespace {

struct Known {
    InstructionSet set;
    std::string_view name;
    bool compiled;
};
#if HEDGEROW_HAS_HIGHWAY
constexpr auto compiled = static_cast<long long>(HWY_TARGETS);
constexpr bool avx512_compiled = (compiled & HWY_AVX3) != 0, avx2_compiled = (compiled & HWY_AVX2) != 0,
               sse4_compiled = (compiled & HWY_SSE4) != 0, neon_compiled = (compiled & HWY_NEON) != 0;
#else
constexpr bool avx512_compiled = false, avx2_compiled = false, sse4_compiled = false, neon_compiled = false;
#endif
constexpr Known known[] = {{InstructionSet::avx512, "avx512", avx512_compiled},
                           {InstructionSet::avx2, "avx2", avx2_compiled},
                           {InstructionSet::sse4, "sse4", sse4_compiled},
                           {InstructionSet::neon, "neon", neon_compiled},
                           {InstructionSet::plain, "plain", true}};

bool runs_here(InstructionSet set) {
    if (set == InstructionSet::plain) return true;
#if defined(__x86_64__) || defined(__i386__)
    __builtin_cpu_init();
    const bool sse4 = __builtin_cpu_supports("sse4.2");
    const bool avx2 = sse4 && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                      __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
    if (set == InstructionSet::sse4) return sse4;
    if (set == InstructionSet::avx2) return avx2;
    return set == InstructionSet::avx512 && avx2 && __builtin_cpu_supports("avx512f") &&
           __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512bw");
#else
    return set == InstructionSet::neon;  // which every AArch64 processor has
#endif
}

/// Those that can be used, best first.
const std::vector<InstructionSet>& usable() {
    static const std::vector<InstructionSet> all = [] {
        std::vector<InstructionSet> found;
        for (const Known& k : known)
            if (k.compiled && runs_here(k.set)) found.push_back(k.set);
        return found;
    }();
    return all;
}
/// Finds one that can be used by its name.
bool find(std::string_view name, InstructionSet& found) {
    for (const InstructionSet set : usable())
        if (name_of(set) == name) return found = set, true;
    return false;
}
std::atomic<InstructionSet>& chosen() {
    static std::atomic<InstructionSet> set = [] {
        InstructionSet asked{};
        const char* const name = std::getenv("HEDGEROW_INSTRUCTION_SET");
        return name != nullptr && find(name, asked) ? asked : usable().front();
    }();
    return set;
}

}  // namespace

InstructionSet instruction_set() {
    return chosen().load(std::memory_order_relaxed);
}
std::string_view name_of(InstructionSet set) {
    for (const Known& k : known)
        if (k.set == set) return k.name;
    return {};
}
std::vector<std::string_view> instruction_sets() {
    std::vector<std::string_view> names;
    for (const InstructionSet set : usable()) names.push_back(name_of(set));
    return names;
}
void use_instruction_set(std::string_view name) {
    InstructionSet found{};
    if (!find(name, found)) {
        std::string all;
        for (const auto n : instruction_sets()) all += (all.empty() ? "" : ", ") + std::string(n);
        throw UsageError("instruction set '" + std::string(name) + "' is not to be had here; there are " +
                         all);
    }
    chosen().store(found, std::memory_order_relaxed);
}

}  // namespace hedgerow
