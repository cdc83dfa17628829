/// Which kernels this processor can run, and which are in use.
#include <atomic>
#include <cstdlib>
#include <string>

#include <hedgerow/base/error.h>
#include <hedgerow/engine/kernels.h>

#include "compiled.h"

namespace hedgerow {
namespace {

bool runs_here(std::string_view instruction_set) {
#if defined(__x86_64__) || defined(__i386__)
    __builtin_cpu_init();
    const bool sse4 = __builtin_cpu_supports("sse4.2");
    const bool avx2 = sse4 && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                      __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
    if (instruction_set == "sse4") return sse4;
    if (instruction_set == "avx2") return avx2;
    return avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
#else
    return instruction_set == "neon";  // which every AArch64 processor has
#endif
}

constexpr std::string_view plain = "plain";

const std::vector<const WideKernels*>& usable() {
    static const std::vector<const WideKernels*> all = [] {
        std::vector<const WideKernels*> found;
        for (const WideKernels* k : detail::compiled_wide_kernels())
            if (runs_here(k->instruction_set)) found.push_back(k);
        return found;
    }();
    return all;
}
/// Finds kernels by name. `plain` is found as nullptr. False for any other name.
bool find(std::string_view name, const WideKernels*& found) {
    for (const WideKernels* k : usable())
        if (k->instruction_set == name) return found = k, true;
    return found = nullptr, name == plain;
}
std::atomic<const WideKernels*>& chosen() {
    static std::atomic<const WideKernels*> kernels = [] {
        const WideKernels* first = usable().empty() ? nullptr : usable().front();
        const WideKernels* asked = nullptr;
        const char* const name = std::getenv("HEDGEROW_INSTRUCTION_SET");
        return name != nullptr && find(name, asked) ? asked : first;
    }();
    return kernels;
}

}  // namespace

const WideKernels* wide_kernels() {
    return chosen().load(std::memory_order_relaxed);
}

std::vector<std::string_view> instruction_sets() {
    std::vector<std::string_view> names;
    for (const WideKernels* k : usable()) names.push_back(k->instruction_set);
    names.push_back(plain);
    return names;
}

void use_instruction_set(std::string_view name) {
    const WideKernels* found = nullptr;
    if (!find(name, found)) {
        std::string all;
        for (const auto n : instruction_sets()) all += (all.empty() ? "" : ", ") + std::string(n);
        throw UsageError("instruction set '" + std::string(name) + "' is not to be had here; there are " +
                         all);
    }
    chosen().store(found, std::memory_order_relaxed);
}

int preferred_wide_width() {
    const WideKernels* const k = wide_kernels();
    return k != nullptr ? k->width : 8;
}

}  // namespace hedgerow
