/// The list of all structures.
#pragma once

#include <hedgerow/engine/wide_bvh.h>
#include <hedgerow/structures/brute_force.h>
#include <hedgerow/structures/bsp/bsp_tree.h>
#include <hedgerow/structures/bvh/bvh.h>
#include <hedgerow/structures/bvh/volume_bvh.h>
#include <hedgerow/structures/grid/grid.h>
#include <hedgerow/structures/grid/two_level_grid.h>
#include <hedgerow/structures/hash_grid/hash_grid.h>
#include <hedgerow/structures/kdtree/kdtree.h>
#include <hedgerow/structures/kdtree/point_kdtree.h>
#include <hedgerow/structures/orthtree/orthtree.h>
#include <hedgerow/structures/orthtree/point_orthtree.h>
#include <hedgerow/walks/fold.h>
