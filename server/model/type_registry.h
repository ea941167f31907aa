/// The known component types, and where types that are not loaded yet come from.
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "plab/registrar.h"

namespace plab::model
{

/// A loaded type with its declaration. The schema belongs to a prototype table without rows: use it for reading, not for
/// storage.
struct ComponentType
{
    TypeInfo info;
    Schema schema;
    std::string plugin;
    std::unique_ptr<TableBase> prototype;

    /// Index into info.commands, or -1.
    int find_command(std::string_view name) const;
    /// Whether a component of this type does any work in `phase`.
    bool takes_part(Phase phase) const;
    /// Whether all that a component of this type does is to advance those that name it: it is a solver, and names nobody itself.
    bool only_advances() const;
    /// Whether all that a component of this type does is to say what happens where bodies touch, in the name of a detection: it is a
    /// response, a resolution or a manager. Which objects are integrated or coupled does not depend on it.
    bool only_answers_contacts() const;
    /// Whether contacts may depend on a component of this type. They do not on solvers, nor on forces, joints, couplings and scripts, which
    /// act on objects otherwise.
    bool concerns_contacts() const;
    /// Why a component of this type cannot replace one of `other`; empty if it can.
    std::string why_not_exchangeable(const ComponentType& other) const;
};

/// The source of types. The plugin library loads on demand; tests use a fixed set.
class TypeSource
{
public:
    virtual ~TypeSource() = default;
    /// The type, loaded if necessary. The error names the most similar known names.
    virtual Result<const ComponentType*> require(const std::string& name) = 0;
    /// All names that require() would find, sorted; loads nothing.
    virtual std::vector<std::string> names() const = 0;
};

/// The type that a user means by `written`: the one of that name in `names`; otherwise the only one whose name ends in "/" +
/// `written`, searched first among those that begin with `within` ("Rows" within "Response/": "Response/Rows"). `written`
/// itself if none matches; an error if several do.
Result<std::string> full_type_name(std::string_view written, const std::vector<std::string>& names, std::string_view within);

/// Types that have been registered, by name.
class TypeRegistry
{
public:
    /// Takes over what a plugin registered. Refuses a type, field or role that is declared twice, and rules that its own
    /// defaults violate.
    Result<void> add(Registrar&& registrar, const std::string& plugin);
    const ComponentType* find(std::string_view name) const;
    const std::deque<ComponentType>& types() const { return types_; }

private:
    std::deque<ComponentType> types_;  // a deque, so that addresses do not change
};

}  // namespace plab::model
