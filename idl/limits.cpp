#include "idl/limits.h"

#include <algorithm>

namespace plab::wire
{

bool is_server_name(const std::string& name)
{
    const auto allowed = [](char c)
    { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '_' || c == '-'; };
    return !name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), allowed);
}

}  // namespace plab::wire
