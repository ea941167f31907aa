/// One field of all components of a type: an array with one element per row.
///
/// A plugin's table is a struct of columns. The host resizes them together, and reads and writes single cells by name through ColumnBase
/// (requests, mementos, hashes); phase functions use the typed arrays.
#pragma once

#include <cstddef>
#include <vector>

#include "plab/bytes.h"
#include "plab/ref.h"
#include "plab/result.h"
#include "plab/value.h"

namespace plab
{

class ColumnBase
{
public:
    virtual ~ColumnBase() = default;
    virtual FieldType type() const = 0;
    virtual std::size_t size() const = 0;
    virtual void resize(std::size_t rows) = 0;
    /// Sets the element's own default and frees what an opaque object held.
    virtual void reset(Row row) = 0;
    /// The cell as a value; an opaque cell gives "no value".
    virtual Value get(Row row) const = 0;
    /// Sets the cell. The value must be of this column's type; the parser has checked it.
    virtual void set(Row row, const Value& value) = 0;
    virtual void save(Row row, ByteWriter& out) const = 0;
    virtual void load(Row row, ByteReader& in) = 0;

protected:
    ColumnBase() = default;
    ColumnBase(const ColumnBase&) = default;
    ColumnBase& operator=(const ColumnBase&) = default;
};

template <class T>
inline constexpr bool kIsField = kFieldTypeOf<T> != FieldType::Opaque;

/// A column of T. bool, int64, double, Vec3, Quat, Mat3, string, Reals, Integers and Entries are fields that the host can read; Ref and
/// RefList are filled by the host from roles; any other T is an opaque object of the plugin.
template <class T>
class Column final : public ColumnBase
{
    // std::vector<bool> has no references, so a truth value is stored in a byte.
    struct Cell
    {
        T value{};
    };

public:
    T& operator[](Row row) { return cells_[row].value; }
    const T& operator[](Row row) const { return cells_[row].value; }

    FieldType type() const override { return kFieldTypeOf<T>; }
    std::size_t size() const override { return cells_.size(); }
    void resize(std::size_t rows) override { cells_.resize(rows); }
    void reset(Row row) override { cells_[row].value = T{}; }
    Value get(Row row) const override
    {
        if constexpr (kIsField<T>)
            return Value(std::in_place_type<T>, cells_[row].value);
        else
            return {};
    }
    void set(Row row, const Value& value) override
    {
        if constexpr (kIsField<T>) cells_[row].value = std::get<T>(value);
    }
    void save(Row row, ByteWriter& out) const override
    {
        if constexpr (kIsField<T>) write(out, cells_[row].value);
    }
    void load(Row row, ByteReader& in) override
    {
        if constexpr (kIsField<T>) read(in, cells_[row].value);
    }

private:
    std::vector<Cell> cells_;
};

}  // namespace plab
