/// server/docs/stability.md, made of the cases and the table.
#pragma once

#include "table.h"

namespace plab::stability
{

std::string page(const std::vector<Case>& cases, const Table& table);

}  // namespace plab::stability
