#include "control/recordings/schema.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <map>

namespace plab::recordings
{
namespace
{

using link::DynamicMember;
using link::DynamicType;
using link::DynamicTypePtr;
using Kind = DynamicType::Kind;

constexpr int kMostNesting = 16;  // sequences in sequences

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// Words ("plab::v2::Frame" is one), numbers and single signs; comments are left out.
std::vector<std::string> tokens_of(std::string_view text)
{
    std::vector<std::string> out;
    for (std::size_t i = 0; i < text.size();)
    {
        const std::size_t begin = i;
        if (text.substr(i, 2) == "//")
            i = std::min(text.find('\n', i), text.size());
        else if (text.substr(i, 2) == "/*")
            i = std::min(text.find("*/", i), text.size() - 2) + 2;
        else if (is_word(text[i]) || text.substr(i, 2) == "::")
        {
            while (i < text.size() && (is_word(text[i]) || text.substr(i, 2) == "::")) i += is_word(text[i]) ? 1 : 2;
            out.emplace_back(text.substr(begin, i - begin));
        }
        else if (std::isspace(static_cast<unsigned char>(text[i])) == 0)
            out.emplace_back(text.substr(i++, 1));
        else
            ++i;
    }
    return out;
}

const std::map<std::string_view, Kind>& primitives()
{
    static const std::map<std::string_view, Kind> table{
        {"boolean", Kind::Boolean},
        {"octet", Kind::Octet},
        {"uint8", Kind::Octet},
        {"char", Kind::Char},
        {"short", Kind::Int16},
        {"int16", Kind::Int16},
        {"long", Kind::Int32},
        {"int32", Kind::Int32},
        {"long long", Kind::Int64},
        {"int64", Kind::Int64},
        {"unsigned short", Kind::Uint16},
        {"uint16", Kind::Uint16},
        {"unsigned long", Kind::Uint32},
        {"uint32", Kind::Uint32},
        {"unsigned long long", Kind::Uint64},
        {"uint64", Kind::Uint64},
        {"float", Kind::Float32},
        {"double", Kind::Float64},
    };
    return table;
}

std::shared_ptr<DynamicType> make(Kind kind)
{
    auto out = std::make_shared<DynamicType>();
    out->kind = kind;
    return out;
}

/// Once something is not understood, every further step fails.
class Parser
{
public:
    explicit Parser(std::string_view idl) : tokens_(tokens_of(idl)) {}

    Result<DynamicTypePtr> find(const std::string& name)
    {
        while (why_.empty() && at_ < tokens_.size()) declaration();
        if (why_.empty() && !scopes_.empty()) why_ = "module " + scopes_.back() + " does not end";
        if (!why_.empty()) return reason("the schema's IDL cannot be parsed: " + why_);
        const auto found = types_.find(name);
        if (found == types_.end()) return reason("the schema's IDL does not declare " + name);
        return found->second;
    }

private:
    const std::string& now() const
    {
        static const std::string end;
        return at_ < tokens_.size() ? tokens_[at_] : end;
    }
    std::string take() { return at_ < tokens_.size() ? tokens_[at_++] : std::string(); }
    bool accept(std::string_view token)
    {
        if (now() != token || token.empty()) return false;
        ++at_;
        return true;
    }
    bool fail(std::string why)
    {
        if (why_.empty()) why_ = std::move(why);
        at_ = tokens_.size();
        return false;
    }
    bool expect(std::string_view token) { return accept(token) || fail("'" + std::string(token) + "' is missing before '" + now() + "'"); }

    /// Annotations before something; what is known of them is kept.
    struct Notes
    {
        bool is_key = false, is_appendable = false;
    };
    Notes annotations()
    {
        Notes out;
        while (accept("@"))
        {
            const std::string name = take();
            out.is_key = out.is_key || name == "key";
            out.is_appendable = out.is_appendable || name == "appendable";
            if (name == "mutable" || name == "optional") (void)fail("@" + name);
            if (accept("("))
                while (!accept(")") && at_ < tokens_.size()) ++at_;
        }
        return out;
    }

    void declaration()
    {
        const Notes notes = annotations();
        if (accept("module"))
        {
            scopes_.push_back(take());
            (void)expect("{");
        }
        else if (accept("}"))
        {
            if (scopes_.empty()) return (void)fail("a '}' too many");
            scopes_.pop_back();
            (void)expect(";");
        }
        else if (accept("struct"))
            structure(notes);
        else if (accept("enum"))
            enumeration();
        else if (accept("typedef"))
            alias();
        else
            (void)fail("'" + now() + "'");
    }

    std::string scoped(const std::string& name, std::size_t scopes) const
    {
        std::string out;
        for (std::size_t i = 0; i < scopes; ++i) out += scopes_[i] + "::";
        return out + name;
    }
    void add(const std::string& name, DynamicTypePtr type) { types_[scoped(name, scopes_.size())] = std::move(type); }

    void structure(const Notes& notes)
    {
        auto out = make(Kind::Struct);
        const std::string name = take();
        out->name = scoped(name, scopes_.size());
        out->is_appendable = notes.is_appendable;
        if (accept(":"))
            if (const DynamicTypePtr base = named(take()); base != nullptr) out->members = base->members;
        if (!expect("{")) return;
        while (why_.empty() && !accept("}")) members(*out);
        (void)expect(";");
        add(name, std::move(out));
    }

    /// "double x, y[3];"
    void members(DynamicType& of)
    {
        const Notes notes = annotations();
        const DynamicTypePtr type = type_here(0);
        do {
            std::string name = take();
            of.members.push_back({std::move(name), with_dimensions(type), notes.is_key});
        } while (why_.empty() && accept(","));
        (void)expect(";");
    }

    void enumeration()
    {
        auto out = make(Kind::Enum);
        const std::string name = take();
        out->name = scoped(name, scopes_.size());
        if (!expect("{")) return;
        std::int32_t next = 0;
        do {
            (void)annotations();
            out->literals.emplace_back(next++, take());
        } while (why_.empty() && accept(","));
        (void)expect("}"), (void)expect(";");
        add(name, std::move(out));
    }

    void alias()
    {
        const DynamicTypePtr type = type_here(0);
        const std::string name = take();
        add(name, with_dimensions(type));
        (void)expect(";");
    }

    std::uint32_t number()
    {
        const std::string text = take();
        std::uint32_t value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc() || end != text.data() + text.size()) (void)fail("'" + text + "' is not a number");
        return value;
    }

    DynamicTypePtr with_dimensions(const DynamicTypePtr& type)
    {
        if (now() != "[") return type;
        auto out = make(Kind::Array);
        out->element = type;
        while (accept("["))
        {
            out->dimensions.push_back(number());
            (void)expect("]");
        }
        return out;
    }

    DynamicTypePtr named(const std::string& name)
    {
        if (name.starts_with("::")) return named_exactly(name.substr(2));
        for (std::size_t scopes = scopes_.size() + 1; scopes-- > 0;)
            if (const auto found = types_.find(scoped(name, scopes)); found != types_.end()) return found->second;
        (void)fail("'" + name + "' is not declared before it is used");
        return make(Kind::Octet);
    }
    DynamicTypePtr named_exactly(const std::string& name)
    {
        if (const auto found = types_.find(name); found != types_.end()) return found->second;
        (void)fail("'::" + name + "' is not declared before it is used");
        return make(Kind::Octet);
    }

    DynamicTypePtr type_here(int depth)
    {
        if (depth > kMostNesting) (void)fail("sequences are nested too deeply");
        if (accept("sequence")) return sequence(depth);
        std::string word = take();
        if (word == "unsigned") word += " " + take();
        if ((word == "long" || word == "unsigned long") && accept("long")) word += " long";
        if (word == "string")
        {
            auto out = make(Kind::String);
            if (accept("<")) out->bound = number(), (void)expect(">");
            return out;
        }
        const auto found = primitives().find(word);
        return found != primitives().end() ? make(found->second) : named(word);
    }

    DynamicTypePtr sequence(int depth)
    {
        auto out = make(Kind::Sequence);
        if (!expect("<")) return out;
        out->element = type_here(depth + 1);
        if (accept(",")) out->bound = number();
        (void)expect(">");
        return out;
    }

    std::vector<std::string> tokens_;
    std::size_t at_ = 0;
    std::string why_;
    std::vector<std::string> scopes_;
    std::map<std::string, DynamicTypePtr> types_;
};

}  // namespace

Result<DynamicTypePtr> type_in(std::string_view idl, const std::string& name) { return Parser(idl).find(name); }

Result<DynamicTypePtr> type_of(const recording::Schema& schema)
{
    if (schema.encoding != "omgidl") return reason("its schema is '" + schema.encoding + "', not omgidl");
    return type_in(schema.data, schema.name);
}

}  // namespace plab::recordings
