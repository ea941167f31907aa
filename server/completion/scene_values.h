/// What stands for ids, types and fields on the command line of a program that is given a scene.
#pragma once

#include "program/completion.h"

namespace plab::completion
{

/// Of the scene that the line names; without one, or with one that has errors, types alone.
program::Values scene_values(const program::Wanted& wanted);

}  // namespace plab::completion
