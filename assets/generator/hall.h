// The parts of the gallery hall: a barrel-vaulted nave of seven bays between two aisles, garden windows on the right, an apse at
// the far end. x to the right, y up, z toward the entrance; the nave runs from z = 0 to z = -21.
#pragma once
#include "architecture.h"
#include "detail.h"

namespace spanray::assets::hall {

constexpr int kBays = 7;
constexpr double kBay = 3.0, kLength = kBays * kBay;
constexpr double kColumnX = 3.0;      // axes of the colonnades
constexpr double kWallX = 5.8;        // inner faces of the outer walls
constexpr double kArcadeDepth = 0.7;
constexpr double kArchRadius = 1.08, kSpring = 3.4;
constexpr double kArcadeTop = 5.25;
constexpr double kVaultSpring = 5.5, kVaultRadius = 2.75;
constexpr double kAisleCeiling = 5.0;
constexpr double kStone = 3.0;        // meters a repeat of the ashlar texture

inline double bay_center(int bay) { return -(bay + 0.5) * kBay; }
inline double axis_z(int k) { return -k * kBay; }
// Another cut of the ashlar for each bay, by whole blocks.
inline glm::dvec2 stone_shift(int k) { return {static_cast<double>((k * 2) % 3), 0.5 * static_cast<double>((k * 5) % 6)}; }

void add_arcades(ObjMesh& mesh, const Detail& detail);
void add_walls(ObjMesh& mesh, const Detail& detail);
void add_ends(ObjMesh& mesh, const Detail& detail);
void add_vault(ObjMesh& mesh, const Detail& detail);
void add_floor(ObjMesh& mesh, const Detail& detail);
void add_garden(ObjMesh& mesh, const Detail& detail);
void add_ironwork(ObjMesh& mesh, const Detail& detail);
void add_curtains(ObjMesh& mesh, const Detail& detail);
void add_lanterns(ObjMesh& mesh, const Detail& detail);
void add_cases(ObjMesh& mesh, const Detail& detail);
void add_sculptures(ObjMesh& mesh, const Detail& detail);

// A hollow for a statue, half a cylinder under half a dome, open toward +z of the placement; its axis at x = z = 0.
void hollow(ObjMesh& mesh, const Placement& at, double radius, double bottom, double spring, int segments, int rows, double texture_size);

}  // namespace spanray::assets::hall
