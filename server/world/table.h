/// The rows of one component type in a world: stored by columns; a row keeps its place as long as it exists.
#pragma once

#include <memory>
#include <vector>

#include "model/type_registry.h"
#include "world/layout.h"

namespace plab::world
{

class Table
{
public:
    explicit Table(const model::ComponentType& type);

    const model::ComponentType& type() const { return *type_; }
    const Schema& schema() const { return schema_; }
    /// The layout of what save() writes for kLiveKinds; shared with holders of such bytes.
    const std::shared_ptr<const Layout>& layout() const { return layout_; }
    void* rows() const { return storage_->rows(); }

    /// Adds a row with the declared defaults, for the component with this directory index and host row.
    Row add(std::uint32_t component, std::uint32_t host_index);
    /// Frees the row and what its opaque cells hold.
    void remove(Row row);
    /// Assigns an existing row that belongs to no component at present (a swap under trial keeps the old row parked).
    void assign(Row row, std::uint32_t component, std::uint32_t host_index);

    std::span<const std::uint32_t> component_of_row() const { return component_of_row_; }
    std::span<const std::uint32_t> host_of_row() const { return host_of_row_; }
    std::size_t capacity() const { return component_of_row_.size(); }

    /// Raw bytes of the fields of one row, of the kinds in `kinds` (one bit per FieldKind), without hosted fields and roles. holds():
    /// whether there is such a field.
    bool holds(unsigned kinds) const;
    void save(Row row, unsigned kinds, ByteWriter& out) const;
    void load(Row row, unsigned kinds, ByteReader& in);

private:
    const model::ComponentType* type_;
    std::unique_ptr<TableBase> storage_;
    Schema schema_;
    std::shared_ptr<const Layout> layout_;
    std::vector<ColumnBase*> columns_;
    std::vector<std::uint32_t> component_of_row_;
    std::vector<std::uint32_t> host_of_row_;
    std::vector<Row> free_;
};

constexpr unsigned kind_bit(FieldKind kind) { return 1u << static_cast<unsigned>(kind); }
inline constexpr unsigned kStateKinds = kind_bit(FieldKind::State);
inline constexpr unsigned kLiveKinds = kind_bit(FieldKind::Param) | kind_bit(FieldKind::State) | kind_bit(FieldKind::Output);

}  // namespace plab::world
