#include "model/value_numbers.h"

namespace plab::model
{

std::size_t number_count(const Value& v)
{
    switch (type_of(v))
    {
        case FieldType::Boolean:
        case FieldType::Integer:
        case FieldType::Real:
            return 1;
        case FieldType::Vector:
            return 3;
        case FieldType::Rotation:
            return 4;
        case FieldType::RealList:
            return std::get<Reals>(v).size();
        default:
            return 0;
    }
}

void append_numbers(const Value& v, std::vector<double>& out)
{
    if (const auto* b = std::get_if<bool>(&v)) out.push_back(*b ? 1 : 0);
    if (const auto* n = std::get_if<std::int64_t>(&v)) out.push_back(static_cast<double>(*n));
    if (const auto* d = std::get_if<double>(&v)) out.push_back(*d);
    if (const auto* x = std::get_if<Vec3>(&v)) out.insert(out.end(), {x->x, x->y, x->z});
    if (const auto* q = std::get_if<Quat>(&v)) out.insert(out.end(), {q->w, q->x, q->y, q->z});
    if (const auto* list = std::get_if<Reals>(&v)) out.insert(out.end(), list->begin(), list->end());
}

std::vector<std::string> number_suffixes(const Value& v)
{
    if (std::holds_alternative<Vec3>(v)) return {".x", ".y", ".z"};
    if (std::holds_alternative<Quat>(v)) return {".w", ".x", ".y", ".z"};
    std::vector<std::string> out(number_count(v));
    if (std::holds_alternative<Reals>(v))
        for (std::size_t k = 0; k < out.size(); ++k) out[k] = "." + std::to_string(k + 1);
    return out;
}

}  // namespace plab::model
