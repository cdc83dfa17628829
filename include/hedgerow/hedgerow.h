/// What most programs include: all structures, primitives and queries, instances and surfaces.
#pragma once

#include <hedgerow/all.h>
#include <hedgerow/caster.h>
#include <hedgerow/instances/instance_set.h>
#include <hedgerow/mesh_index.h>
#include <hedgerow/primitives/point_cloud.h>
#include <hedgerow/primitives/segment_set.h>
#include <hedgerow/primitives/sphere_set.h>
#include <hedgerow/surface.h>
