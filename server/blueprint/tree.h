/// From XML elements to blueprint nodes: the grammar of the blueprint language.
#pragma once

#include <string>

#include "blueprint/foreign.h"
#include "blueprint/xml.h"
#include "model/blueprint.h"

namespace plab::blueprint
{

/// Errors in order of discovery, up to a maximum number; the rest are only counted.
class Complaints
{
public:
    explicit Complaints(std::string file) : file_(std::move(file)) {}

    void add(TextPosition where, std::string element, std::string why)
    {
        add(Error{{{}, where.line, where.column}, std::move(element), std::move(why)});
    }
    void add(Error error)
    {
        if (error.where.file.empty()) error.where.file = file_;
        if (errors_.size() < kMost)
            errors_.push_back(std::move(error));
        else
            ++omitted_;
    }
    /// Whether further errors are only counted, so that their text need not be built.
    bool full() const { return errors_.size() >= kMost; }
    bool any() const { return !errors_.empty(); }
    /// All errors; the last one states how many are not shown.
    Errors take()
    {
        if (omitted_ > 0) errors_.push_back({{file_, 0, 0}, {}, std::to_string(omitted_) + " more errors are not shown"});
        return std::move(errors_);
    }

private:
    static constexpr std::size_t kMost = 100;
    std::string file_;
    Errors errors_;
    std::size_t omitted_ = 0;
};

/// Builds a Blueprint out of the pieces that parse_xml() delivers.
class TreeReader final : public XmlSink
{
public:
    TreeReader(const std::string& file, const ForeignHandlers& handlers, Complaints& complaints)
        : handlers_(handlers), complaints_(complaints)
    {
        blueprint_.file = file;
    }

    bool begin(const XmlElement& root) override;
    void child(XmlElement element) override;
    void end(XmlElement root) override;

    model::Blueprint take() { return std::move(blueprint_); }

private:
    SourceLocation at(TextPosition where) const { return {blueprint_.file, where.line, where.column}; }

    // Checks that are the same for all elements.
    void misplaced(const XmlElement& e, const std::string& parent);
    void check_attributes(const XmlElement& e, std::initializer_list<std::string_view> allowed);
    void refuse_text(const XmlElement& e);
    void refuse_children(const XmlElement& e);
    /// The attribute, trimmed; empty if it is absent. Complains when it is longer than an id may be.
    std::string name_attribute(const XmlElement& e, std::string_view name);
    std::string required_name(const XmlElement& e, std::string_view name);
    std::string reference(const XmlElement& e);

    void scene(const XmlElement& e);
    model::ComponentNode camera(const XmlElement& e);
    model::RepeatNode repeat(const XmlElement& e);
    model::ComponentNode component(const XmlElement& e);
    void component_part(const XmlElement& e, model::ComponentNode& out, bool after_command);
    void foreign(const XmlElement& e, const ForeignHandler& handler, model::ComponentNode& out);
    void state(const XmlElement& e, model::ComponentNode& out);
    void add_entry(const XmlElement& e, model::TextNode& out);
    model::TextNode parameter(const XmlElement& e);
    model::CommandNode command(const XmlElement& e);
    model::TextNode command_parameter(const XmlElement& e);
    void command_value(const XmlElement& udata, model::TextNode& out);

    const ForeignHandlers& handlers_;
    Complaints& complaints_;
    model::Blueprint blueprint_;
    TextPosition scene_at_;
    bool known_root_ = false;
};

}  // namespace plab::blueprint
