/// Samples of the catalogue's topics as plain structs: texts and sequences are copied out of DDS's memory.
#pragma once

#include "idl/topics.h"
#include "link/catalogue_data.h"

namespace plab::link
{

Scene scene_of(const plab_v2_Scene& sample);
Object object_of(const plab_v2_SceneObject& sample);
/// Index triples that refer to nonexistent vertices are left out.
Shape shape_of(const plab_v2_Shape& sample);
Interaction interaction_of(const plab_v2_Interaction& sample);
Type type_of(const plab_v2_Type& sample);

}  // namespace plab::link
