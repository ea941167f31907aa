/// The shader programs of the renderer, as GLSL 3.30 source.
#pragma once

#include <string>

namespace plab::render
{

struct ShaderText
{
    std::string name, vertex, fragment;
};

ShaderText solid_shader();
/// Spheres that are small in the picture, as squares.
ShaderText ball_shader();
ShaderText solid_shadow_shader();
ShaderText ball_shadow_shader();
/// The ground's grid and Form::Plane.
ShaderText plane_shader();
/// The shadows of items on a plane.
ShaderText plane_shadow_shader();
ShaderText background_shader();

}  // namespace plab::render
