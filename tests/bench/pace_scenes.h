/// Scenes of the benches as blueprint text: pieces, and heaps of many bodies.
#pragma once

#include <string>

#include "plab/vector.h"

namespace plab::bench
{

std::string component(const std::string& id, const std::string& type, const std::string& more);
/// `dt`: s, as a blueprint has it.
std::string scene(const std::string& dt, const std::string& parts);
std::string numbered(const char* name, int i);
/// A rigid body, `at` in m.
std::string body(int i, const Vec3& at, const std::string& more = "shape=\"s\" mass=\"1\"");
/// Gravity for all; a plane and a body for it, "ground".
extern const std::string kGravity, kGround;
/// SoftStep with 4 sub-steps and no location of impacts, as an engine for games has it.
std::string heap_contact(double friction);

std::string free_bodies(int n);
std::string wall(int columns, int rows);
/// Columns of ten cubes, nearly in touch.
std::string pile(int n);
/// Balls in a box.
std::string balls(int n);
/// Balls and boxes that fall; no algorithm is named.
std::string newcomers_heap(int n);
/// Cubes on one another, as they stand: a tower, and a pyramid with so many at the bottom. `manager`: SoftStep, Direct ...; empty:
/// nothing is named.
std::string tower(int high, const std::string& manager = "");
std::string pyramid(int wide, const std::string& manager = "");
/// Cubes in stacks of three that are put down on springs.
std::string stacks_on_springs(int n);
/// Cubes that stand apart; no algorithm is named.
std::string cubes_apart(int n);
/// Solids of one shape that fall in random orientations into one heap, 0.2 m large. `type`, `parameters`: of the shape.
std::string tumbled(const char* type, const std::string& parameters, int n);
/// Chains of five boxes on ball joints that fall into one heap; no algorithm is named but Resolution/None.
std::string chains_in_a_heap(int n);
/// Robots of four legs that drop from 0.1 m above their feet and stand: servos of 60 N m/rad and 2 N m s/rad at eight hinges each.
std::string four_legged(int n);
/// Links of 0.1 kg on ball joints that hang from the world with a ball of 1000 kg, released level; no algorithm is named.
std::string heavy_chain(int links);
/// Points on a ball of 0.26 m, for a Shape/ConvexHull.
std::string twenty_corners();

}  // namespace plab::bench
