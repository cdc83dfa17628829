/// The instruction sets that kernels are compiled for, and which of them is in use.
///
/// The kernels of a component (engine, nbody) are one source, compiled for every instruction set that the
/// compiler knows (AVX-512, AVX2, SSE4; NEON) and chosen at run time.
#pragma once

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

/// The kernels of a kind that are in use, or nullptr where there are none and plain code answers. A kind is a
/// struct of functions. Its header declares a specialisation, and the source that compiles them for each
/// instruction set defines it (src/core/in_use.h), so that a new kind touches no other.
template <class Kernels>
const Kernels* in_use();

}  // namespace hedgerow
