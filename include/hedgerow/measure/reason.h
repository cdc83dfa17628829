/// Explains the cost of a structure in words, by its counts.
#pragma once

#include <string>

#include <hedgerow/measure/costs.h>

namespace hedgerow::measure {

/// Describes what a query of the kind did in the structure, as the mean over its sets of rays: "1,565 tests a
/// query: a leaf that it looks into holds 227 triangles, a leaf on the mean 3.1, so the detail lies in few
/// leaves". Names the first of these that applies: the query tests everything; the leaves that it visits are
/// far fuller than the mean leaf; primitives are in many leaves; else its nodes and tests.
std::string reason(const StructureCost& structure, const Comparison& comparison, Ask ask);

}  // namespace hedgerow::measure
