/// The questions that an Index answers, by family, one at a time or many in a batch.
#pragma once

#include <hedgerow/ask/families.h>
#include <hedgerow/ask/hausdorff.h>
#include <hedgerow/ask/insides.h>
#include <hedgerow/ask/oriented_points.h>
#include <hedgerow/ask/pairs.h>
#include <hedgerow/ask/points.h>
#include <hedgerow/ask/rays.h>
#include <hedgerow/ask/regions.h>
