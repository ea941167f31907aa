/// The single declaration of the fields and roles of a component type.
///
/// A table's describe(Schema&) declares each column once. Parsing, checks, storage, memento, hash, requests, --expand, the catalogue and
/// the reference manual are derived from it.
#pragma once

#include <deque>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "plab/column.h"
#include "plab/unit.h"

namespace plab
{

enum class FieldKind : std::uint8_t
{
    Param,    ///< from the blueprint; only requests change it
    State,    ///< evolves; has an initial value; part of memento and hash; carried over in a swap
    Output,   ///< computed by a step; published
    Scratch,  ///< not kept from one step to the next
};

/// A condition on a value; `text` states it in words ("must be positive").
struct Rule
{
    enum class Kind : std::uint8_t
    {
        AtLeast,     ///< every component >= bound
        MoreThan,    ///< every component > bound
        AtMost,      ///< every component <= bound
        NonZero,     ///< a number other than 0, a vector other than the zero vector
        UnitLength,  ///< a direction; normalised on reading, so only the zero vector is refused
        OneOf,       ///< one of a list of texts
    };
    Kind kind;
    double bound = 0;
    std::vector<std::string> options;
};

struct Field
{
    std::string name;
    FieldKind kind = FieldKind::Param;
    FieldType type = FieldType::None;
    Unit unit;
    Value fallback;  ///< default if the blueprint gives none; no value: the field is required
    bool required = false;
    bool may_be_infinite = false;
    bool hosted = false;    ///< the live value is in the host's table of the facet; the column has only the initial value
    bool is_error = false;  ///< an output that accounting reports as the error of this interaction
    bool is_input = false;  ///< a state that is set from outside while the scene runs, and that changes nothing else when it is set
    std::vector<Rule> rules;
    std::string doc;
    ColumnBase* column = nullptr;
};

struct Role
{
    std::string name;
    std::string doc;
    std::vector<Facet> facets;
    std::string family;        ///< for Facet::Component: required type prefix, for example "Response/"
    std::string default_type;  ///< type of the sub-component that the short form creates if none is named
    std::size_t min = 1, max = 1;
    bool writes = false;       ///< acts on the participant; otherwise only reads it
    bool exclusive = false;    ///< no second component may act on the participant through a role of this kind
    bool independent = false;  ///< acts on each participant separately, so it connects no groups
    Column<Ref>* one = nullptr;
    Column<RefList>* many = nullptr;
};

/// Refines the field that was just declared. Reads like a sentence: param(...).or_else(1).positive().
template <class T>
class FieldBuilder
{
public:
    explicit FieldBuilder(Field& field) : field_(&field) {}
    FieldBuilder& or_else(T value)
    {
        return field_->fallback = Value(std::in_place_type<T>, std::move(value)), field_->required = false, *this;
    }
    FieldBuilder& initially(T value) { return or_else(std::move(value)); }
    FieldBuilder& positive() { return rule({Rule::Kind::MoreThan, 0, {}}); }
    FieldBuilder& not_negative() { return rule({Rule::Kind::AtLeast, 0, {}}); }
    FieldBuilder& at_least(double bound) { return rule({Rule::Kind::AtLeast, bound, {}}); }
    FieldBuilder& at_most(double bound) { return rule({Rule::Kind::AtMost, bound, {}}); }
    FieldBuilder& nonzero() { return rule({Rule::Kind::NonZero, 0, {}}); }
    FieldBuilder& unit_length() { return rule({Rule::Kind::UnitLength, 0, {}}); }
    FieldBuilder& one_of(std::vector<std::string> options) { return rule({Rule::Kind::OneOf, 0, std::move(options)}); }
    FieldBuilder& may_be_infinite() { return field_->may_be_infinite = true, *this; }
    /// The host keeps the live value (Bodies, Shafts) under this name; see the facet fields in server/docs/notation.md.
    FieldBuilder& hosted() { return field_->hosted = true, *this; }
    FieldBuilder& reported_as_error() { return field_->is_error = true, *this; }
    /// A request that sets nothing but inputs costs no more than writing them: no trial, no new schedule, no other component is prepared.
    FieldBuilder& input() { return field_->is_input = true, *this; }

private:
    FieldBuilder& rule(Rule r) { return field_->rules.push_back(std::move(r)), *this; }
    Field* field_;
};

class RoleBuilder
{
public:
    explicit RoleBuilder(Role& role) : role_(&role) {}
    RoleBuilder& optional() { return role_->min = 0, *this; }
    RoleBuilder& at_least(std::size_t n) { return role_->min = n, *this; }
    RoleBuilder& writes() { return role_->writes = true, *this; }
    RoleBuilder& exclusive() { return role_->exclusive = true, *this; }
    RoleBuilder& independent() { return role_->independent = true, *this; }
    RoleBuilder& family(std::string prefix) { return role_->family = std::move(prefix), *this; }
    RoleBuilder& default_type(std::string type) { return role_->default_type = std::move(type), *this; }

private:
    Role* role_;
};

/// Collects what describe() declares. Names are snake_case and unique within a type, including roles.
class Schema
{
public:
    /// A parameter; required unless or_else() gives a default.
    template <class T>
    FieldBuilder<T> param(Column<T>& column, std::string name, Unit unit, std::string doc)
    {
        return add<T>(FieldKind::Param, column, std::move(name), unit, std::move(doc), true);
    }
    /// A state; starts from T{} unless initially() gives another value; can be set in the blueprint.
    template <class T>
    FieldBuilder<T> state(Column<T>& column, std::string name, Unit unit, std::string doc)
    {
        return add<T>(FieldKind::State, column, std::move(name), unit, std::move(doc), false);
    }
    template <class T>
    FieldBuilder<T> output(Column<T>& column, std::string name, Unit unit, std::string doc)
    {
        return add<T>(FieldKind::Output, column, std::move(name), unit, std::move(doc), false);
    }
    /// Work memory or an opaque object of the plugin, without a text form.
    template <class T>
    void scratch(Column<T>& column, std::string name, std::string doc)
    {
        add<T>(FieldKind::Scratch, column, std::move(name), unit::one, std::move(doc), false);
    }
    RoleBuilder role(Column<Ref>& column, std::string name, std::vector<Facet> facets, std::string doc)
    {
        Role& r = roles_.emplace_back();
        r.name = std::move(name), r.facets = std::move(facets), r.doc = std::move(doc), r.one = &column;
        return RoleBuilder(r);
    }
    RoleBuilder role(Column<RefList>& column, std::string name, std::vector<Facet> facets, std::string doc)
    {
        Role& r = roles_.emplace_back();
        r.name = std::move(name), r.facets = std::move(facets), r.doc = std::move(doc), r.many = &column;
        r.max = std::numeric_limits<std::size_t>::max();
        return RoleBuilder(r);
    }

    const std::deque<Field>& fields() const { return fields_; }
    const std::deque<Role>& roles() const { return roles_; }
    const Field* find_field(std::string_view name) const
    {
        for (const Field& f : fields_)
            if (f.name == name) return &f;
        return nullptr;
    }
    const Role* find_role(std::string_view name) const
    {
        for (const Role& r : roles_)
            if (r.name == name) return &r;
        return nullptr;
    }
    /// All columns, including those of roles, for resizing them together.
    std::vector<ColumnBase*> columns() const
    {
        std::vector<ColumnBase*> out;
        for (const Field& f : fields_) out.push_back(f.column);
        for (const Role& r : roles_) out.push_back(r.one ? static_cast<ColumnBase*>(r.one) : r.many);
        return out;
    }

private:
    template <class T>
    FieldBuilder<T> add(FieldKind kind, Column<T>& column, std::string name, Unit unit, std::string doc, bool required)
    {
        Field& f = fields_.emplace_back();
        f.name = std::move(name), f.kind = kind, f.type = kFieldTypeOf<T>, f.unit = unit, f.doc = std::move(doc);
        f.column = &column, f.required = required;
        if constexpr (kIsField<T>)
            if (!required) f.fallback = Value(std::in_place_type<T>);
        return FieldBuilder<T>(f);
    }

    // Deques, because builders and the host keep pointers to elements.
    std::deque<Field> fields_;
    std::deque<Role> roles_;
};

}  // namespace plab
