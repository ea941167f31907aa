/// <include> of MJCF: the children of the other file's root stand in its place.
#pragma once

#include "import/document.h"

namespace plab::import
{

/// Replaces each <include file="..."> in `root`, also those of included files; files are looked for in the folder of the document's file.
/// A file counts once, as in MuJoCo. Then joins sections that stand in <mujoco> more than once: their children follow one another. Errors
/// go into `document`.
void put_together(XmlElement& root, Document& document);

}  // namespace plab::import
