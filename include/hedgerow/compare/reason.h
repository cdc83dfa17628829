/// Why a structure costs what it costs, in words made of its counts.
#pragma once

#include <string>

#include <hedgerow/compare/costs.h>

namespace hedgerow::compare {

/// What a query of a kind did in the structure, the mean over its sets of rays: "1,565 tests a query: a leaf
/// that it looks into holds 227 triangles, a leaf on the mean 3.1, so the detail lies in few leaves". Says
/// the first that holds of: it tests everything; full leaves in the way; primitives that stand in many
/// leaves; nodes and tests.
std::string reason(const StructureCost& structure, const Comparison& comparison, Ask ask);

}  // namespace hedgerow::compare
