/// The component types that are known, and where the ones that are not loaded yet can be had.
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "plab/registrar.h"

namespace plab::model
{

/// A loaded type with its declaration. The schema belongs to a prototype table without rows: for reading, not storing.
struct ComponentType
{
    TypeInfo info;
    Schema schema;
    std::string plugin;
    std::unique_ptr<TableBase> prototype;

    /// Index into info.commands, or -1.
    int find_command(std::string_view name) const;
    /// Whether a component of this type has anything to do in `phase`.
    bool takes_part(Phase phase) const;
    /// What keeps a component of this type from standing in for one of `other`; empty if nothing does.
    std::string why_not_exchangeable(const ComponentType& other) const;
};

/// Where types come from. The plugin library loads on demand; tests use a fixed set.
class TypeSource
{
public:
    virtual ~TypeSource() = default;
    /// The type, loaded if need be. The error names the nearest known names.
    virtual Result<const ComponentType*> require(const std::string& name) = 0;
    /// All names that require() would find, sorted; loads nothing.
    virtual std::vector<std::string> names() const = 0;
};

/// The type that a user means by `written`: the one of that name in `names`; else the only one whose name ends in "/" +
/// `written`, looked for first among those that begin with `within` ("Rows" within "Response/": "Response/Rows").
/// `written` itself where nothing fits; an error where several do.
Result<std::string> full_type_name(std::string_view written, const std::vector<std::string>& names, std::string_view within);

/// Types that have been registered, by name.
class TypeRegistry
{
public:
    /// Takes over what a plugin registered. Refuses a doubly declared type, field or role, and rules that its own
    /// defaults break.
    Result<void> add(Registrar&& registrar, const std::string& plugin);
    const ComponentType* find(std::string_view name) const;
    const std::deque<ComponentType>& types() const { return types_; }

private:
    std::deque<ComponentType> types_;  // addresses stay
};

}  // namespace plab::model
