/// A document of another format while it is read: numbers in attributes, errors, and what cannot be carried over, each with its place.
#pragma once

#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "blueprint/xml.h"
#include "plab/vector.h"

namespace plab::import
{

using blueprint::TextPosition;
using blueprint::XmlElement;

class Document
{
public:
    /// At most this many errors are kept.
    static constexpr std::size_t kMostErrors = 100;

    explicit Document(std::string file) : files_{std::move(file)} {}

    /// The file that was asked for.
    const std::string& file() const { return files_.front(); }
    /// The one that holds this place.
    const std::string& file_of(TextPosition where) const { return files_[where.file < files_.size() ? where.file : 0]; }
    /// A file that another one includes; its number, for places in it.
    std::uint32_t add_file(std::string file);
    std::size_t files() const { return files_.size(); }
    void error(TextPosition where, std::string element, std::string why);
    void error(const XmlElement& e, std::string why) { error(e.where, title_of(e), std::move(why)); }
    void lost(TextPosition where, std::string element, std::string why);
    void lost(const XmlElement& e, std::string why) { lost(e.where, title_of(e), std::move(why)); }
    bool failed() const { return !errors_.empty(); }
    Errors& errors() { return errors_; }
    /// What could not be carried over, in the order of the file.
    Errors losses() const;

    /// <joint> 'knee'.
    static std::string title_of(const XmlElement& e);

    /// Up to out.size() numbers, at least `least`; how many there were. 0 if the attribute is missing or faulty (then with an error).
    std::size_t numbers(const XmlElement& e, std::string_view attribute, std::span<double> out, std::size_t least);
    double number(const XmlElement& e, std::string_view attribute, double otherwise);
    Vec3 vector(const XmlElement& e, std::string_view attribute, const Vec3& otherwise);
    /// A number that must be there and be positive; 0 with an error otherwise.
    double positive(const XmlElement& e, std::string_view attribute);
    /// A direction of unit length; an error for the zero vector.
    Vec3 direction(const XmlElement& e, std::string_view attribute, const Vec3& otherwise);
    std::string text(const XmlElement& e, std::string_view attribute) const;
    /// As numbers(), of the text inside e.
    std::size_t numbers_inside(const XmlElement& e, std::span<double> out, std::size_t least);

    /// Lists the attributes of e that are not among `known`.
    void list_attributes(const XmlElement& e, std::initializer_list<std::string_view> known);
    /// Of an element without children.
    void list_all_but(const XmlElement& e, std::initializer_list<std::string_view> known)
    {
        list_attributes(e, known), list_children(e, {});
    }
    /// Lists what stands in e a second time, but for elements of which there may be `several`.
    void list_repeated(const XmlElement& e, std::initializer_list<std::string_view> several);
    /// Lists the children of e that are not among `known`.
    void list_children(const XmlElement& e, std::initializer_list<std::string_view> known);

    /// Whether these can be the mass properties of a body; otherwise an error.
    bool check_mass(TextPosition where, const std::string& element, double mass, const Mat3& inertia);

private:
    std::size_t read_numbers(const XmlElement& e, std::string_view what, const std::string& text, std::span<double> out, std::size_t least);

    std::vector<std::string> files_;
    Errors errors_;
    std::vector<std::pair<TextPosition, Error>> losses_;
};

/// Without blanks at its ends.
std::string_view trimmed(std::string_view text);

const XmlElement* find_child(const XmlElement& e, std::string_view name);

/// The rotation whose matrix has these columns, orthonormal and right-handed.
Quat rotation_of_columns(const Vec3& x, const Vec3& y, const Vec3& z);
/// The shortest rotation that turns z into the unit vector `to`.
Quat rotation_from_z(const Vec3& to);
/// By `angle` (rad) about a unit vector.
Quat rotation_about(const Vec3& axis, double angle);

}  // namespace plab::import
