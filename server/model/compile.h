/// Compiles the blueprint tree to the scene that it describes.
#pragma once

#include "model/blueprint.h"
#include "model/compile_limits.h"
#include "model/scene.h"
#include "model/type_registry.h"

namespace plab::model
{

/// Resolves types (loading plugins), ids, roles, groups, short forms, repeats and stage lists; checks every value. All errors
/// are collected. `existing`: the scene to which a fragment is added; its ids can be referred to but not defined again; the
/// result then contains the fragment's components only.
Result<SceneSpec> compile(const Blueprint& blueprint, TypeSource& types, const SceneSpec* existing = nullptr,
                          const CompileLimits& limits = {});

}  // namespace plab::model
