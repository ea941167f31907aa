#include "blueprint/xgl.h"

#include <charconv>
#include <cmath>
#include <map>
#include <set>

#include "model/numbers.h"
#include "model/text.h"

namespace plab::blueprint
{
namespace
{

/// Elements of a mesh that only affect its appearance.
constexpr std::string_view kAppearance[] = {"N",       "TC",         "MAT",         "SURFACE", "L",   "LINE",
                                            "TEXTURE", "TEXTURERGB", "TEXTURERGBA", "NAME",    "DATA"};

bool is_look(const XmlElement& e)
{
    if (e.name.starts_with("EXT")) return true;  // the specification's prefix for applications' own data
    for (const std::string_view name : kAppearance)
        if (e.name == name) return true;
    return false;
}

/// Parses "x, y, z" into `out`; false if it has another form or is not finite.
bool parse_point(std::string_view text, Reals& out)
{
    for (int i = 0; i < 3; ++i)
    {
        const std::size_t comma = text.find(',');
        if ((comma == text.npos) != (i == 2)) return false;
        std::string_view number = model::trimmed(text.substr(0, comma));
        if (number.starts_with('+')) number.remove_prefix(1);
        double value = 0;
        const auto [end, status] = std::from_chars(number.data(), number.data() + number.size(), value);
        if (status != std::errc() || end != number.data() + number.size() || !std::isfinite(value)) return false;
        out.push_back(value);
        if (i < 2) text.remove_prefix(comma + 1);
    }
    return true;
}

class MeshReading
{
public:
    Result<std::vector<model::ValueNode>> run(const XmlElement& mesh)
    {
        for (const XmlElement& e : mesh.children)
            if (e.name == "P") point(e);
        for (const XmlElement& e : mesh.children) part(e, "<MESH>");
        if (mesh.text_where.line > 0) complain(mesh.text_where, "<MESH>", "unexpected text");
        if (faces_ == 0) complain(mesh.where, "<MESH>", "a mesh needs at least one face <F>");
        if (!errors_.empty()) return std::move(errors_);
        const SourceLocation where{{}, mesh.where.line, mesh.where.column};
        return std::vector<model::ValueNode>{{"vertices", std::move(vertices_), where}, {"triangles", std::move(triangles_), where}};
    }

private:
    void complain(TextPosition at, std::string element, std::string why)
    {
        if (errors_.size() < kMostErrors) errors_.push_back({{{}, at.line, at.column}, std::move(element), std::move(why)});
    }

    void part(const XmlElement& e, const char* parent)
    {
        if (e.name == "P" || e.name == "N" || e.name == "TC") unique_id(e);
        if (e.name == "P" || is_look(e)) return;
        if (e.name == "F") return face(e);
        if (e.name != "PATCH") return complain(e.where, "<" + e.name + ">", std::string("unknown element in ") + parent);
        for (const XmlElement& f : e.children)
            if (f.name == "F" || is_look(f))
                part(f, "<PATCH>");
            else
                complain(f.where, "<" + f.name + ">", "unknown element in <PATCH>");
    }

    void unique_id(const XmlElement& e)
    {
        const std::string* id = e.find_attribute("ID");
        if (!id) return complain(e.where, "<" + e.name + ">", "needs an attribute 'ID'");
        if (!ids_.emplace(e.name, *id).second) complain(e.where, "<" + e.name + ">", "ID " + model::quoted(*id) + " is already defined");
    }

    void point(const XmlElement& e)
    {
        Reals xyz;
        if (!parse_point(e.text, xyz) || !e.children.empty())
        {
            complain(e.where, "<P>", model::quoted(model::trimmed(e.text)) + " is not a point: give three numbers separated by commas");
            xyz.assign(3, 0.0);  // keeps its ID known, so that its faces do not cause errors too
        }
        if (const std::string* id = e.find_attribute("ID")) index_of_.emplace(*id, static_cast<std::int64_t>(vertices_.size() / 3));
        vertices_.insert(vertices_.end(), xyz.begin(), xyz.end());
    }

    void face(const XmlElement& e)
    {
        ++faces_;
        const XmlElement* corners[3] = {};
        for (const XmlElement& c : e.children)
        {
            const int i = c.name.size() == 3 && c.name.starts_with("FV") ? c.name[2] - '1' : -1;
            if (i >= 0 && i < 3 && !corners[i])
                corners[i] = &c;
            else if (i >= 0 && i < 3)
                complain(c.where, "<" + c.name + ">", "the face already has this corner");
            else if (i >= 3 && i < 9)
                complain(c.where, "<" + c.name + ">", "a face has three corners, <FV1> to <FV3>; split it into triangles");
            else if (c.name != "MATREF" && c.name != "TEXTUREREF" && !is_look(c))
                complain(c.where, "<" + c.name + ">", "unknown element in <F>");
        }
        std::int64_t index[3];
        for (int i = 0; i < 3; ++i)
        {
            if (!corners[i]) return complain(e.where, "<F>", "a face needs three corners, <FV1> to <FV3>");
            index[i] = corner(*corners[i]);
            if (index[i] < 0) return;
        }
        if (index[0] == index[1] || index[1] == index[2] || index[2] == index[0])
            return complain(e.where, "<F>", "a face needs three different points");
        triangles_.insert(triangles_.end(), index, index + 3);
    }

    /// The index of a corner's point; -1 after an error was reported.
    std::int64_t corner(const XmlElement& e)
    {
        const XmlElement* found = nullptr;
        for (const XmlElement& c : e.children)
        {
            if (c.name == "PREF" && found) return complain(c.where, "<PREF>", "a corner has one point"), -1;
            if (c.name == "PREF")
                found = &c;
            else if (c.name != "NREF" && c.name != "TCREF" && c.name != "N" && c.name != "TC")
                return complain(c.where, "<" + c.name + ">", "unknown element in <" + e.name + ">"), -1;
        }
        if (!found) return complain(e.where, "<" + e.name + ">", "a corner needs a <PREF>"), -1;
        const std::string_view id = model::trimmed(found->text);
        const auto at = index_of_.find(id);
        if (at == index_of_.end()) return complain(found->where, "<PREF>", "no point <P> has the ID " + model::quoted(id)), -1;
        return at->second;
    }

    static constexpr std::size_t kMostErrors = 20;

    std::map<std::string, std::int64_t, std::less<>> index_of_;
    std::set<std::pair<std::string, std::string>> ids_;
    Reals vertices_;
    Integers triangles_;
    std::size_t faces_ = 0;
    Errors errors_;
};

}  // namespace

Result<std::vector<model::ValueNode>> read_xgl_mesh(const XmlElement& mesh) { return MeshReading().run(mesh); }

ForeignHandlers xgl_handlers()
{
    ForeignHandlers handlers;
    handlers.add({"MESH", "Shape/Mesh", &read_xgl_mesh});
    return handlers;
}

std::string write_xgl_mesh(const Reals& vertices, const Integers& triangles, std::size_t indent)
{
    const std::string outer(indent, ' '), inner(indent + 2, ' ');
    std::string out = outer + "<MESH>\n";
    for (std::size_t i = 0; 3 * i < vertices.size(); ++i)
        out += inner + "<P ID=\"" + std::to_string(i + 1) + "\">" + model::format_real(vertices[3 * i]) + ", " +
               model::format_real(vertices[3 * i + 1]) + ", " + model::format_real(vertices[3 * i + 2]) + "</P>\n";
    for (std::size_t f = 0; f < triangles.size(); f += 3)
    {
        out += inner + "<F>";
        for (std::size_t k = 0; k < 3; ++k)
        {
            const std::string tag = "FV" + std::to_string(k + 1);
            out += "<" + tag + "><PREF>" + std::to_string(triangles[f + k] + 1) + "</PREF></" + tag + ">";
        }
        out += "</F>\n";
    }
    return out + outer + "</MESH>\n";
}

bool is_xgl_mesh(const Reals& vertices, const Integers& triangles)
{
    const std::int64_t points = static_cast<std::int64_t>(vertices.size() / 3);
    if (vertices.size() % 3 != 0 || triangles.size() % 3 != 0 || triangles.empty()) return false;
    for (const double v : vertices)
        if (!std::isfinite(v)) return false;
    for (std::size_t f = 0; f < triangles.size(); f += 3)
    {
        const std::int64_t a = triangles[f], b = triangles[f + 1], c = triangles[f + 2];
        if (a == b || b == c || c == a) return false;
        for (const std::int64_t i : {a, b, c})
            if (i < 0 || i >= points) return false;
    }
    return true;
}

}  // namespace plab::blueprint
