#include "idl/recording/topic_file.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <vector>

#include "idl/recording/plab_idl_text.h"

namespace plab::recording
{

void TopicFile::write(const wire::Topic& topic, ByteView sample, const Stamp& stamp)
{
    // A sample that is dropped because the disk fails is counted by the writer.
    if (const ChannelId channel = channel_of(topic); channel > 0)
        (void)writer_.write({channel, 0, stamp.log_time, stamp.publish_time, sample}, stamp.now);
}

ChannelId TopicFile::channel_of(const wire::Topic& topic)
{
    if (const auto known = channels_.find(&topic); known != channels_.end()) return known->second;
    const auto declared = declare(topic);
    if (!declared) refuse(declared.error());
    return channels_[&topic] = declared ? *declared : ChannelId{0};
}

Result<ChannelId> TopicFile::declare(const wire::Topic& topic)
{
    auto schema = schema_of(topic);
    if (!schema) return schema.errors();
    const auto schema_id = writer_.add_schema(schema.take());
    if (!schema_id) return schema_id.errors();
    return writer_.add_channel(recording::channel_of(topic, *schema_id));
}

void TopicFile::refuse(Error why)
{
    if (!refused_) refused_ = std::move(why);
}

void TopicFile::attach(std::uint64_t log_time, std::string name, std::string media_type, std::string text)
{
    pending_.push_back({log_time, std::move(name), std::move(media_type), std::move(text)});
    attach_pending();
}

void TopicFile::attach_pending()
{
    while (!pending_.empty())
    {
        const Enclosure& e = pending_.front();
        const auto* text = reinterpret_cast<const std::uint8_t*>(e.text.data());
        if (!writer_.attach({e.log_time, 0, e.name, e.media_type, {text, e.text.size()}})) return;
        pending_.pop_front();
    }
}

void TopicFile::retry()
{
    if (writer_.retry()) attach_pending();
}

Result<void> TopicFile::close()
{
    retry();
    if (!pending_.empty()) refuse(reason(pending_.front().name + " could not be stored in the recording"));
    auto closed = writer_.close();
    if (!closed || !refused_) return closed;
    return *refused_;
}

namespace
{

struct Declaration
{
    std::string name;
    std::string text;                ///< with its ';'
    std::vector<std::string> words;  ///< all identifiers in it
};

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

std::vector<std::string> words_of(std::string_view text)
{
    std::vector<std::string> out;
    for (std::size_t i = 0; i < text.size();)
    {
        const std::size_t begin = i;
        while (i < text.size() && is_word(text[i])) ++i;
        if (i > begin)
            out.emplace_back(text.substr(begin, i - begin));
        else
            ++i;
    }
    return out;
}

/// Removes comments, and replaces each run of white space by one space.
std::string without_comments(std::string_view idl)
{
    std::string out;
    for (std::size_t i = 0; i < idl.size();)
    {
        if (idl.substr(i, 2) == "//")
            i = std::min(idl.find('\n', i), idl.size());
        else if (idl.substr(i, 2) == "/*")
            i = std::min(idl.find("*/", i), idl.size() - 2) + 2;
        else
        {
            const bool is_space = std::isspace(static_cast<unsigned char>(idl[i])) != 0;
            if (!is_space)
                out += idl[i];
            else if (!out.empty() && out.back() != ' ')
                out += ' ';
            ++i;
        }
    }
    return out;
}

/// The name that a declaration defines: the word after "struct", or the last one of a typedef before its dimensions.
std::string name_in(const std::string& text, const std::vector<std::string>& words)
{
    for (std::size_t i = 0; i + 1 < words.size(); ++i)
        if (words[i] == "struct" || words[i] == "enum" || words[i] == "union") return words[i + 1];
    const std::vector<std::string> before = words_of(std::string_view(text).substr(0, text.find('[')));
    return before.empty() ? "" : before.back();
}

/// The contents of the innermost module, declaration by declaration.
std::vector<Declaration> declarations_of(std::string_view body)
{
    std::vector<Declaration> out;
    int depth = 0;
    std::size_t begin = 0;
    for (std::size_t i = 0; i < body.size(); ++i)
    {
        if (body[i] == '{') ++depth;
        if (body[i] == '}') --depth;
        if (body[i] != ';' || depth != 0) continue;
        while (body[begin] == ' ') ++begin;
        Declaration d;
        d.text = body.substr(begin, i + 1 - begin);
        d.words = words_of(d.text);
        d.name = name_in(d.text, d.words);
        out.push_back(std::move(d));
        begin = i + 1;
    }
    return out;
}

/// Names of all types that `name` uses, itself included.
std::set<std::string> needed_for(const std::string& name, const std::vector<Declaration>& all)
{
    std::set<std::string> needed{name};
    // Declarations only refer to those before them.
    for (auto d = all.rbegin(); d != all.rend(); ++d)
        if (needed.contains(d->name)) needed.insert(d->words.begin(), d->words.end());
    return needed;
}

}  // namespace

Result<std::string> select_idl(std::string_view idl, std::string_view type_name)
{
    const std::string text = without_comments(idl);
    std::string head, tail;
    std::string_view rest(text);
    std::string scope;
    const auto skip_space = [&] { rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size())); };
    for (skip_space(); rest.starts_with("module "); skip_space())
    {
        const std::size_t open = rest.find('{');
        if (open == std::string_view::npos) return reason("the IDL has a module without '{'");
        scope += words_of(rest.substr(0, open)).back() + "::";
        head += std::string(rest.substr(0, open + 1)) + "\n";
        tail += "};\n";
        rest.remove_prefix(open + 1);
    }
    const auto modules = static_cast<std::size_t>(std::count(tail.begin(), tail.end(), '}'));
    for (std::size_t i = 0; i < modules && rest.rfind('}') != std::string_view::npos; ++i) rest = rest.substr(0, rest.rfind('}'));

    const std::vector<Declaration> all = declarations_of(rest);
    const bool is_in_scope = type_name.starts_with(scope);
    const std::string name(is_in_scope ? type_name.substr(scope.size()) : type_name);
    const auto has_name = [&](const Declaration& d) { return d.name == name; };
    if (!is_in_scope || std::none_of(all.begin(), all.end(), has_name)) return reason("the IDL declares no " + std::string(type_name));
    const std::set<std::string> needed = needed_for(name, all);
    std::string out = head;
    for (const Declaration& d : all)
        if (needed.contains(d.name)) out += d.text + "\n";
    return out + tail;
}

Result<std::string> idl_of(std::string_view type_name) { return select_idl(kPlabIdl, type_name); }

Result<Schema> schema_of(const wire::Topic& topic)
{
    auto idl = idl_of(topic.type->m_typename);
    if (!idl) return idl.errors();
    return Schema{0, topic.type->m_typename, "omgidl", idl.take()};
}

Channel channel_of(const wire::Topic& topic, std::uint16_t schema_id) { return {0, schema_id, topic.name, "cdr", {}}; }

}  // namespace plab::recording
