// From XTypes TypeObjects, which Cyclone DDS fetches and checks, to DynamicType.
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_typelib.h>
#include <dds/ddsi/ddsi_xt_typeinfo.h>

#include <map>

#include "link/discovery.h"

namespace plab::link
{
namespace
{

using Kind = DynamicType::Kind;
using Identifier = DDS_XTypes_TypeIdentifier;
using Described = Result<DynamicTypePtr>;

constexpr int kMostDepth = 32;

DynamicTypePtr make(Kind kind)
{
    auto type = std::make_shared<DynamicType>();
    type->kind = kind;
    return type;
}

struct Primitive
{
    std::uint8_t id;
    Kind kind;
};
constexpr Primitive kPrimitives[]{
    {DDS_XTypes_TK_BOOLEAN, Kind::Boolean}, {DDS_XTypes_TK_BYTE, Kind::Octet},    {DDS_XTypes_TK_INT16, Kind::Int16},
    {DDS_XTypes_TK_INT32, Kind::Int32},     {DDS_XTypes_TK_INT64, Kind::Int64},   {DDS_XTypes_TK_UINT16, Kind::Uint16},
    {DDS_XTypes_TK_UINT32, Kind::Uint32},   {DDS_XTypes_TK_UINT64, Kind::Uint64}, {DDS_XTypes_TK_FLOAT32, Kind::Float32},
    {DDS_XTypes_TK_FLOAT64, Kind::Float64}, {DDS_XTypes_TK_CHAR8, Kind::Char},
};

/// The name of an IDL construct that is not supported here.
std::string words_for(std::uint8_t kind)
{
    switch (kind)
    {
        case DDS_XTypes_TK_FLOAT128:
            return "a long double";
        case DDS_XTypes_TK_CHAR16:
            return "a wide character";
        case DDS_XTypes_TI_STRING16_SMALL:
        case DDS_XTypes_TI_STRING16_LARGE:
            return "a wide string";
        case DDS_XTypes_TK_UNION:
            return "a union";
        case DDS_XTypes_TK_BITMASK:
            return "a bit mask";
        case DDS_XTypes_TK_BITSET:
            return "a bit set";
        case DDS_XTypes_TI_PLAIN_MAP_SMALL:
        case DDS_XTypes_TI_PLAIN_MAP_LARGE:
        case DDS_XTypes_TK_MAP:
            return "a map";
        case DDS_XTypes_EK_MINIMAL:
            return "a type without names";
        case DDS_XTypes_TI_STRONGLY_CONNECTED_COMPONENT:
            return "a type that contains itself";
        default:
            return "of kind " + std::to_string(kind);
    }
}

class Describer
{
public:
    explicit Describer(dds_entity_t participant) : participant_(participant) {}

    /// `path` is its location, for the message.
    Described identified(const Identifier& id, const std::string& path, int depth)
    {
        if (depth > kMostDepth) return refuse(path, "deeper than " + std::to_string(kMostDepth) + " levels");
        for (const Primitive& primitive : kPrimitives)
            if (primitive.id == id._d) return make(primitive.kind);
        switch (id._d)
        {
            case DDS_XTypes_TI_STRING8_SMALL:
                return string(id._u.string_sdefn.bound);
            case DDS_XTypes_TI_STRING8_LARGE:
                return string(id._u.string_ldefn.bound);
            case DDS_XTypes_TI_PLAIN_SEQUENCE_SMALL:
                return sequence(*id._u.seq_sdefn.element_identifier, id._u.seq_sdefn.bound, path, depth);
            case DDS_XTypes_TI_PLAIN_SEQUENCE_LARGE:
                return sequence(*id._u.seq_ldefn.element_identifier, id._u.seq_ldefn.bound, path, depth);
            case DDS_XTypes_TI_PLAIN_ARRAY_SMALL:
                return array(*id._u.array_sdefn.element_identifier, bounds(id._u.array_sdefn.array_bound_seq), path, depth);
            case DDS_XTypes_TI_PLAIN_ARRAY_LARGE:
                return array(*id._u.array_ldefn.element_identifier, bounds(id._u.array_ldefn.array_bound_seq), path, depth);
            case DDS_XTypes_EK_COMPLETE:
                return looked_up(id, path, depth);
            default:
                return refuse(path, words_for(id._d));
        }
    }

private:
    static Error refuse(const std::string& path, const std::string& what)
    {
        return reason((path.empty() ? "it" : "'" + path + "'") + " is " + what + ", which is not supported");
    }

    static Described string(std::uint32_t bound)
    {
        auto type = std::make_shared<DynamicType>();
        type->kind = Kind::String, type->bound = bound;
        return DynamicTypePtr(type);
    }

    template <class Bounds>
    static std::vector<std::uint32_t> bounds(const Bounds& sequence)
    {
        return {sequence._buffer, sequence._buffer + sequence._length};
    }

    Described sequence(const Identifier& element, std::uint32_t bound, const std::string& path, int depth)
    {
        auto inner = identified(element, path + "[]", depth + 1);
        if (!inner) return inner;
        auto type = std::make_shared<DynamicType>();
        type->kind = Kind::Sequence, type->element = inner.take(), type->bound = bound;
        return DynamicTypePtr(type);
    }

    Described array(const Identifier& element, std::vector<std::uint32_t> dimensions, const std::string& path, int depth)
    {
        auto inner = identified(element, path + "[]", depth + 1);
        if (!inner) return inner;
        auto type = std::make_shared<DynamicType>();
        type->kind = Kind::Array, type->element = inner.take(), type->dimensions = std::move(dimensions);
        return DynamicTypePtr(type);
    }

    /// A type with a type object of its own; each is described once.
    Described looked_up(const Identifier& id, const std::string& path, int depth)
    {
        const std::string hash(reinterpret_cast<const char*>(id._u.equivalence_hash), sizeof id._u.equivalence_hash);
        if (const auto known = known_.find(hash); known != known_.end()) return known->second;
        dds_typeobj_t* raw = nullptr;
        const auto* const type_id = reinterpret_cast<const dds_typeid_t*>(&id);  // its only member
        if (const auto code = dds_get_typeobj(participant_, type_id, 0, &raw); code < 0)
            return refuse(path, std::string("of a type that its writer does not describe (") + dds_strretcode(code) + ")");
        const std::unique_ptr<dds_typeobj_t, dds_return_t (*)(dds_typeobj_t*)> owner(raw, &dds_free_typeobj);
        const auto& object = *reinterpret_cast<const DDS_XTypes_TypeObject*>(raw);  // its only member
        if (object._d != DDS_XTypes_EK_COMPLETE) return refuse(path, words_for(DDS_XTypes_EK_MINIMAL));
        auto type = complete(object._u.complete, path, depth);
        if (type) known_[hash] = *type;
        return type;
    }

    Described complete(const DDS_XTypes_CompleteTypeObject& object, const std::string& path, int depth)
    {
        switch (object._d)
        {
            case DDS_XTypes_TK_STRUCTURE:
                return structure(object._u.struct_type, path, depth);
            case DDS_XTypes_TK_ENUM:
                return enumerated(object._u.enumerated_type);
            case DDS_XTypes_TK_ALIAS:
                return identified(object._u.alias_type.body.common.related_type, path, depth + 1);
            case DDS_XTypes_TK_SEQUENCE:
            {
                const auto& s = object._u.sequence_type;
                return sequence(s.element.common.type, s.header.common.bound, path, depth);
            }
            case DDS_XTypes_TK_ARRAY:
            {
                const auto& a = object._u.array_type;
                return array(a.element.common.type, bounds(a.header.common.bound_seq), path, depth);
            }
            default:
                return refuse(path, words_for(object._d));
        }
    }

    Described structure(const DDS_XTypes_CompleteStructType& from, const std::string& path, int depth)
    {
        if ((from.struct_flags & DDS_XTypes_IS_MUTABLE) != 0) return refuse(path, "a mutable struct");
        auto type = std::make_shared<DynamicType>();
        type->kind = Kind::Struct;
        type->name = from.header.detail.type_name;
        type->is_appendable = (from.struct_flags & DDS_XTypes_IS_APPENDABLE) != 0;
        if (from.header.base_type._d != DDS_XTypes_TK_NONE)
        {
            auto base = identified(from.header.base_type, path, depth + 1);
            if (!base) return base;
            type->members = (*base)->members;
        }
        for (std::uint32_t i = 0; i < from.member_seq._length; ++i)
        {
            const auto& member = from.member_seq._buffer[i];
            const std::string where = (path.empty() ? "" : path + ".") + member.detail.name;
            if ((member.common.member_flags & DDS_XTypes_IS_OPTIONAL) != 0) return refuse(where, "optional");
            auto inner = identified(member.common.member_type_id, where, depth + 1);
            if (!inner) return inner;
            type->members.push_back({member.detail.name, inner.take(), (member.common.member_flags & DDS_XTypes_IS_KEY) != 0});
        }
        return DynamicTypePtr(type);
    }

    static Described enumerated(const DDS_XTypes_CompleteEnumeratedType& from)
    {
        auto type = std::make_shared<DynamicType>();
        type->kind = Kind::Enum;
        type->name = from.header.detail.type_name;
        const auto bits = from.header.common.bit_bound;
        type->enum_bytes = bits <= 8 ? 1 : bits <= 16 ? 2 : 4;
        for (std::uint32_t i = 0; i < from.literal_seq._length; ++i)
            type->literals.emplace_back(from.literal_seq._buffer[i].common.value, from.literal_seq._buffer[i].detail.name);
        return DynamicTypePtr(type);
    }

    dds_entity_t participant_;
    std::map<std::string, DynamicTypePtr> known_;
};

}  // namespace

Described describe_type(dds_entity_t participant, const dds_typeinfo_t* type)
{
    const auto* const id = ddsi_typeinfo_complete_typeid(type);
    if (id == nullptr) return reason("its writer does not describe it");
    return Describer(participant).identified(*reinterpret_cast<const Identifier*>(id), "", 0);
}

}  // namespace plab::link
