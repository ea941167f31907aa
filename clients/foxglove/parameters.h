/// Parameters of components as Foxglove has parameters: "gears.velocity_factor", with values as numbers, lists and texts.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "foxglove/protocol.h"
#include "link/catalogue.h"

namespace plab::foxglove
{

/// Of a list of all; of more, it is cut, and parameters must be asked for by name.
inline constexpr std::size_t kMostListed = 2000;

/// Null: no component has it. The last '.' separates the two, for ids may have dots.
const link::Parameter* find_parameter(const link::CatalogueContents& now, const std::string& name);
/// Of the kinds param and level, sorted; at most kMostListed + 1.
std::vector<std::string> parameter_names(const link::CatalogueContents& now);
/// {name, value, type}; without value if there is no such parameter.
Json parameter_json(const std::string& name, const link::Parameter* parameter);
Json parameters_json(const link::CatalogueContents& now, const std::vector<std::string>& names);

/// One `set` for each component. An error says which name is wrong.
Result<std::vector<link::Operation>> set_operations(const std::vector<wire::NamedText>& values);

/// Which parameters one client watches, and what it knows of them.
class ParameterWatch
{
public:
    static constexpr std::size_t kMost = 4096;  ///< names

    void change(const WatchParameters& said);
    bool is_empty() const { return !all_ && names_.empty(); }
    /// What has changed since the last call; at first everything that is watched. Empty: nothing.
    Json changes(const link::CatalogueContents& now);

private:
    bool all_ = false;
    std::set<std::string> names_;
    std::map<std::string, std::string> known_;
};

}  // namespace plab::foxglove
