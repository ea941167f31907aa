/// Ids of components as names of frames, joints and entities in ROS.
#pragma once

#include <map>
#include <set>
#include <string>

namespace plab::ros
{

/// The frame to which all others are relative: pLab's W.
inline constexpr const char* kWorldFrame = "world";

/// An id may be any text; a name has letters, digits and _ . - / only, begins with none of the last three, and no two ids have the same
/// one. A name stays with its id as long as that exists.
class NameTable
{
public:
    const std::string& name_of(const std::string& id);
    /// "" if no component has this name.
    const std::string& id_of(const std::string& name) const;
    /// Forgets all ids but these.
    void keep_only(const std::set<std::string>& ids);

private:
    std::map<std::string, std::string> names_;  ///< by id
    std::map<std::string, std::string> ids_;    ///< by name
};

/// The name of an id, if no other id had it.
std::string plain_name(const std::string& id);

}  // namespace plab::ros
