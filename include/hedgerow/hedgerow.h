/// Everything.
#pragma once

#include <hedgerow/ask.h>
#include <hedgerow/primitives/instance_set.h>
#include <hedgerow/primitives/point_cloud.h>
#include <hedgerow/primitives/segment_set.h>
#include <hedgerow/primitives/sphere_set.h>
#include <hedgerow/primitives/triangle_mesh.h>
#include <hedgerow/structures/all.h>
#include <hedgerow/surface.h>
