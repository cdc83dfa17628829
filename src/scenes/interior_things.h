/// Furniture and other things in the rooms. Lengths are in metres. A thing at a wall has its back there: x
/// runs along the wall, y into the room, and its origin is the middle of its back on the floor. Any other
/// thing stands on its origin, or hangs from it.
#pragma once

#include <hedgerow/scenes/random.h>

#include "interior_model.h"

namespace hedgerow::detail {

// Furniture.
void table(Model& m, const Pose& p, const Vec3d& size);
void chair(Model& m, const Pose& p);
void sofa(Model& m, const Pose& p, double width);
void bookcase(Model& m, const Pose& p, double width, int shelves);
void bed(Model& m, const Pose& p);
/// A body with doors side by side, each with a bevelled panel and a handle.
void cupboard(Model& m, const Pose& p, const Vec3d& size, int doors);

// Fittings.
/// The casing of an opening on the face of a wall; the opening's lower left corner is the origin.
void casing(Model& m, const Pose& p, const Vec2d& size);
/// The leaf of a door in an opening whose lower left corner is the origin, opened to the direction `ajar`.
void door(Model& m, const Pose& p, const Vec2d& size, const Vec2d& ajar);
/// A frame with bars of 15 mm in an opening whose lower left corner is the origin.
void window(Model& m, const Pose& p, const Vec2d& size);
void curtain(Model& m, const Pose& p, double width, double height);
void blind(Model& m, const Pose& p, const Vec2d& size);
void radiator(Model& m, const Pose& p, double width);
/// A moulding at the foot of a wall, from the origin on.
void skirting(Model& m, const Pose& p, double length);
/// A moulding at the top of a wall, from the origin on.
void cornice(Model& m, const Pose& p, double length, double height);
/// Planks of 9 cm with gaps of 2 mm over a rectangle from the origin on.
void floorboards(Model& m, const Pose& p, const Vec2d& size, Random random);
void tiles(Model& m, const Pose& p, int columns, int rows);

// Small things.
void pendant_lamp(Model& m, const Pose& p, double length);
void standing_lamp(Model& m, const Pose& p);
void vase(Model& m, const Pose& p, double height);
/// A bowl of spheres.
void fruit_bowl(Model& m, const Pose& p, Random random);
/// A plate, a glass, and cutlery that is 1 mm thick.
void table_setting(Model& m, const Pose& p);
void cup(Model& m, const Pose& p);
void pot(Model& m, const Pose& p, double radius);
/// Books in a row from the origin on: covers of 2 mm around blocks of pages.
void books(Model& m, const Pose& p, double width, Random random);
void pens(Model& m, const Pose& p, Random random);
void picture(Model& m, const Pose& p, const Vec2d& size);
void plant(Model& m, const Pose& p, int leaves, Random random);
void rug(Model& m, const Pose& p, const Vec2d& size);

}  // namespace hedgerow::detail
