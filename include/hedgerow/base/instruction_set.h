/// The instruction sets that kernels are compiled for, and which of them is in use.
///
/// The kernels of a component (engine, nbody) are one source, compiled for every instruction set that the
/// compiler knows (AVX-512, AVX2, SSE4; NEON) and chosen at run time.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

namespace hedgerow {

/// `plain` has no kernels: the code of the headers answers.
enum class InstructionSet : std::size_t { plain, sse4, avx2, avx512, neon };

/// The one in use. The first call chooses it: the one that the environment variable HEDGEROW_INSTRUCTION_SET
/// names, or the best there is. A name that `instruction_sets()` lacks is ignored. In the library `core`.
InstructionSet instruction_set();
std::string_view name_of(InstructionSet set);

/// The instruction sets that this processor and this build have, best first. "plain" is last and always
/// there.
std::vector<std::string_view> instruction_sets();
/// Switches to another instruction set, from now on and for all threads. Throws UsageError for a name that is
/// not in the list.
void use_instruction_set(std::string_view name);

/// The kernels of a component for each InstructionSet, or nullptr where it has none.
template <class Kernels>
using KernelTables = std::array<const Kernels*, 5>;

template <class Kernels>
const Kernels* in_use(const KernelTables<Kernels>& tables) {
    return tables[static_cast<std::size_t>(instruction_set())];
}

}  // namespace hedgerow
