#include "simulation/snapshot/format_cells.h"

#include <algorithm>
#include <map>

#include "model/values.h"
#include "simulation/snapshot/format_scene.h"

namespace plab::simulation
{
namespace
{

/// Not a possible name of a field.
constexpr std::string_view kComponent = ".component";

/// An empty column for values of a field type, and its elements as values.
template <std::size_t I = 0>
ColumnData column_for(const Value& example)
{
    if constexpr (I < std::variant_size_v<ColumnData>)
    {
        using Element = typename std::variant_alternative_t<I, ColumnData>::value_type;
        if constexpr (kIsField<Element>)
            if (std::holds_alternative<Element>(example)) return std::vector<Element>{};
        return column_for<I + 1>(example);
    }
    return std::vector<Value>{};
}

void append(ColumnData& column, const Value& value)
{
    std::visit(
        [&](auto& list)
        {
            using Element = typename std::decay_t<decltype(list)>::value_type;
            if constexpr (kIsField<Element>) list.push_back(std::get<Element>(value));
        },
        column);
}

/// Column types whose elements are not field values give an empty value.
Value element(const ColumnData& column, std::size_t row)
{
    return std::visit(
        [&](const auto& list) -> Value
        {
            using Element = typename std::decay_t<decltype(list)>::value_type;
            if constexpr (kIsField<Element>)
                return Value(std::in_place_type<Element>, list[row]);
            else
                return {};
        },
        column);
}

const Value* given(const model::ComponentSpec& spec, const std::string& field)
{
    const auto at = std::find_if(spec.fields.begin(), spec.fields.end(), [&](const model::FieldSpec& f) { return f.name == field; });
    return at == spec.fields.end() ? nullptr : &at->value;
}

/// The components of one type, collected for their section.
struct Gathered
{
    const world::Layout* layout = nullptr;
    std::vector<std::uint32_t> rows;
    std::vector<ColumnData> columns;
    std::vector<bool> as_given;  ///< by column
};

void gather(const world::Layout& layout, const model::ComponentSpec& spec, std::uint32_t row, ByteReader& cells, Gathered& out)
{
    const bool first = out.rows.empty();
    out.layout = &layout;
    out.rows.push_back(row);
    for (std::size_t k = 0; k < layout.fields.size(); ++k)
    {
        const world::FieldLayout& field = layout.fields[k];
        const Value value = world::read_value(cells, field.type);
        if (first) out.columns.push_back(column_for(value)), out.as_given.push_back(field.kind == FieldKind::Param);
        append(out.columns[k], value);
        const Value* authored = out.as_given[k] ? given(spec, field.name) : nullptr;
        out.as_given[k] = authored && world::same_bits(*authored, value);
    }
}

/// The section of a type, and the row of each component in it.
struct Cells
{
    const model::ComponentType* type = nullptr;
    const Section* section = nullptr;
    world::Layout layout;
    std::vector<const NamedColumn*> columns;  ///< by layout.fields; null: the value is the one given by the scene
    std::map<std::uint32_t, std::size_t> place;
};

Errors find_fields(Cells& cells)
{
    const std::string where = cells.type->info.name + ": the snapshot's field '";
    Errors errors;
    for (const NamedColumn& column : cells.section->columns)
    {
        if (column.name == kComponent) continue;
        const Field* field = cells.type->schema.find_field(column.name);
        if (!field || field->hosted || !(world::kLiveKinds & world::kind_bit(field->kind)))
            errors.push_back(reason(where + column.name + "' is unknown to this build of the type"));
        else if (cells.section->rows > 0 && type_of(element(column.data, 0)) != field->type)
            errors.push_back(reason(where + column.name + "' has another type in this build"));
        else
            cells.layout.fields.push_back({field->name, field->kind, field->type}), cells.columns.push_back(&column);
    }
    return errors;
}

/// Adds params that are not in the file because they are as the scene gives them.
void add_given(Cells& cells, const std::vector<const model::ComponentSpec*>& specs)
{
    for (const Field& field : cells.type->schema.fields())
    {
        if (field.kind != FieldKind::Param || field.hosted || cells.section->find(field.name)) continue;
        const auto gives = [&](const model::ComponentSpec* spec) { return given(*spec, field.name) != nullptr; };
        if (!std::all_of(specs.begin(), specs.end(), gives)) continue;
        cells.layout.fields.push_back({field.name, field.kind, field.type}), cells.columns.push_back(nullptr);
    }
}

Result<void> find_places(Cells& cells)
{
    const NamedColumn* components = cells.section->find(kComponent);
    const auto* rows = components ? std::get_if<std::vector<std::uint32_t>>(&components->data) : nullptr;
    if (!rows) return reason("the snapshot has no section '" + cells.section->name + "' with its components");
    for (std::size_t i = 0; i < rows->size(); ++i) cells.place[(*rows)[i]] = i;
    return {};
}

Result<Cells> open_cells(const std::string& type_name, const std::vector<Section>& sections,
                         const std::vector<const model::ComponentSpec*>& specs, model::TypeSource& types)
{
    Cells out;
    auto type = types.require(type_name);
    if (!type) return type.errors();
    out.type = *type, out.section = &find_section(sections, std::string(kCellsPrefix) + type_name);
    out.layout.type = type_name, out.layout.facet = (*type)->info.facet;
    if (auto done = find_places(out); !done) return reason(type_name + ": " + done.error().reason);
    if (Errors errors = find_fields(out); !errors.empty()) return errors;
    add_given(out, specs);
    return out;
}

Result<void> write_row(const Cells& cells, const model::ComponentSpec& spec, std::uint32_t row, ByteWriter& out)
{
    const auto at = cells.place.find(row);
    if (at == cells.place.end()) return Error{{}, spec.id, "has no values in the snapshot"};
    for (std::size_t k = 0; k < cells.columns.size(); ++k)
    {
        const world::FieldLayout& field = cells.layout.fields[k];
        const Value value = cells.columns[k] ? element(cells.columns[k]->data, at->second) : *given(spec, field.name);
        if (field.kind == FieldKind::Param)
        {
            Value checked = value;
            if (auto fits = model::check_value(checked, *cells.type->schema.find_field(field.name)); !fits)
                return Error{{}, spec.id, field.name + ": " + fits.error().reason};
        }
        world::write_value(out, value);
    }
    return {};
}

}  // namespace

std::vector<Section> write_cells(const world::Image& image)
{
    std::map<std::string, std::uint32_t> row_of;
    for (const model::ComponentSpec& c : image.scene->components) row_of.emplace(c.id, static_cast<std::uint32_t>(row_of.size()));
    std::map<std::string, Gathered> types;
    ByteReader cells(image.cells);
    image.for_each(
        [&](std::uint32_t, const world::Component& c, const world::Layout& layout)
        {
            const std::uint32_t row = row_of.at(c.id);
            gather(layout, image.scene->components[row], row, cells, types[layout.type]);
        });
    std::vector<Section> out;
    for (auto& [name, gathered] : types)
    {
        Section section{std::string(kCellsPrefix) + name, gathered.rows.size(), {}};
        section.columns.push_back({std::string(kComponent), std::move(gathered.rows)});
        for (std::size_t k = 0; k < gathered.columns.size(); ++k)
            if (!gathered.as_given[k]) section.columns.push_back({gathered.layout->fields[k].name, std::move(gathered.columns[k])});
        out.push_back(std::move(section));
    }
    return out;
}

Result<void> read_cells(const std::vector<Section>& sections, model::TypeSource& types, world::Directory& directory, world::Image& image)
{
    std::map<std::string, std::vector<const model::ComponentSpec*>> specs;
    for (const model::ComponentSpec& c : image.scene->components)
        if (!c.type.empty()) specs[c.type].push_back(&c);
    std::map<std::string, std::pair<std::uint32_t, Cells>> open;
    for (const auto& [type, of_type] : specs)
    {
        auto cells = open_cells(type, sections, of_type, types);
        if (!cells) return cells.errors();
        image.layouts.push_back(std::make_shared<world::Layout>(cells->layout));
        open.emplace(type, std::pair(static_cast<std::uint32_t>(open.size()), cells.take()));
    }
    for (const Section& section : sections)
        if (section.name.starts_with(kCellsPrefix) && !open.contains(section.name.substr(kCellsPrefix.size())))
            return reason("the snapshot has values in '" + section.name + "', but nothing of that type in its scene");

    ByteWriter cells;
    for (std::uint32_t row = 0; row < image.scene->components.size(); ++row)
    {
        const model::ComponentSpec& spec = image.scene->components[row];
        if (spec.type.empty()) continue;
        const auto& [table, of_type] = open.at(spec.type);
        directory.components[row].table = table, directory.components[row].facet = of_type.layout.facet;
        if (auto done = write_row(of_type, spec, row, cells); !done) return done;
    }
    image.cells = cells.bytes();
    return {};
}

}  // namespace plab::simulation
