#include "program/completion.h"

#include <algorithm>

#include "program/man_page.h"

namespace plab::program
{
namespace
{

bool is_option(const std::string& word) { return word.size() > 1 && word.front() == '-'; }

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

/// Follows the words up to the cursor as the parser would.
class Walk
{
public:
    explicit Walk(const CommandOutline& program) : program_(program), command_(&program) {}

    void take(const std::string& word)
    {
        if (is_option(word)) return take_option(word);
        if (pending_ != nullptr) return take_value(word);
        if (const CommandOutline* const chosen = command_ == &program_ ? program_.find(word) : nullptr)
        {
            command_ = chosen, out_.command = chosen->name;
            return;
        }
        if (const OptionOutline* const place = next_place()) out_.given[place->place].push_back(word);
        ++places_;
    }

    Wanted at(const std::string& word)
    {
        const std::size_t equal = word.find('=');
        if (word.starts_with("--") && equal != std::string::npos)
        {
            const OptionOutline* const option = find(word.substr(0, equal));
            out_.before = word.substr(0, equal + 1), out_.begun = word.substr(equal + 1);
            if (option != nullptr && option->has_value) want(*option, option->names.back());
            return std::move(out_);
        }
        out_.begun = word;
        if (!word.empty() && word.front() == '-')
            add_options();
        else if (pending_ != nullptr)
            want(*pending_, pending_->names.back());
        else
            add_places();
        return std::move(out_);
    }

private:
    const OptionOutline* find(const std::string& name) const
    {
        const OptionOutline* const own = command_->option(name);
        return own != nullptr ? own : program_.option(name);
    }

    const OptionOutline* next_place() const
    {
        const auto& places = command_->places;
        if (places_ < places.size()) return &places[places_];
        return !places.empty() && places.back().most > 1 ? &places.back() : nullptr;
    }

    void take_option(const std::string& word)
    {
        const std::size_t equal = word.find('=');
        pending_ = find(word.substr(0, equal));
        if (pending_ != nullptr && !pending_->has_value) pending_ = nullptr;
        left_ = pending_ != nullptr ? pending_->most : 0;
        if (equal != std::string::npos && pending_ != nullptr) take_value(word.substr(equal + 1));
    }

    void take_value(const std::string& word)
    {
        out_.given[pending_->names.back()].push_back(word);
        if (--left_ <= 0) pending_ = nullptr;
    }

    void want(const OptionOutline& option, const std::string& name)
    {
        out_.value = option.value, out_.option = name;
        for (const std::string& w : option.words) out_.candidates.push_back({w, ""});
    }

    void add_options()
    {
        for (const CommandOutline* const c : {command_, &program_})
        {
            for (const OptionOutline& o : c->options)
                for (const std::string& name : o.names)
                    // Long names say more, and there is one for nearly each.
                    if (name.starts_with("--") || o.names.size() == 1) out_.candidates.push_back({name, first_line(o.help)});
            if (c == &program_) break;
        }
    }

    void add_places()
    {
        if (command_ == &program_)
            for (const CommandOutline& c : program_.commands) out_.candidates.push_back({c.name, first_line(c.help)});
        if (const OptionOutline* const place = next_place()) want(*place, place->place);
    }

    const CommandOutline& program_;
    const CommandOutline* command_;
    const OptionOutline* pending_ = nullptr;
    int left_ = 0;
    std::size_t places_ = 0;
    Wanted out_;
};

/// A line is a line: no control characters in it, wherever it comes from.
std::string one_line(std::string text)
{
    for (char& c : text)
        if (static_cast<unsigned char>(c) < ' ') c = ' ';
    return text;
}

}  // namespace

std::string Wanted::first(const std::string& name) const
{
    const auto at = given.find(name);
    return at == given.end() || at->second.empty() ? std::string() : at->second.front();
}

Wanted wanted_at(const CommandOutline& program, const std::vector<std::string>& words)
{
    Walk walk(program);
    for (std::size_t i = 0; i + 1 < words.size(); ++i) walk.take(words[i]);
    return walk.at(words.empty() ? std::string() : words.back());
}

std::string completion_lines(const CommandOutline& program, const std::vector<std::string>& words, const ValueSource& values)
{
    Wanted wanted = wanted_at(program, words);
    Values known;
    if (!wanted.value.empty() && wanted.candidates.empty() && values) known = values(wanted);
    std::vector<Candidate> all = std::move(wanted.candidates);
    all.insert(all.end(), known.candidates.begin(), known.candidates.end());
    std::erase_if(all, [&](const Candidate& c) { return !c.word.starts_with(wanted.begun) || c.word.empty(); });
    std::sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) { return a.word < b.word; });
    all.erase(std::unique(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) { return a.word == b.word; }), all.end());
    std::string out;
    // What is to be done comes first: a word never begins with a colon.
    if (known.are_files) out += ":files\n";
    if (known.go_on) out += ":nospace\n";
    for (const Candidate& c : all)
        if (!c.word.starts_with(':')) out += one_line(wanted.before + c.word) + "\t" + one_line(c.help) + "\n";
    return out;
}

std::optional<std::string> answer_for_shell(const CommandOutline& program, int argc, const char* const* argv, const std::string& version,
                                            const ValueSource& values, const std::string& more)
{
    const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
    if (words.empty() || (words[0] != "--complete" && words[0] != "--print")) return {};
    if (words[0] == "--complete") return completion_lines(program, {words.begin() + 1, words.end()}, values);
    if (words.size() == 2 && words[1] == "man") return man_page(program, version, more);
    const std::string script = words.size() == 2 ? completion_script(program.name, words[1]) : std::string();
    if (script.empty()) return {};
    return script;
}

}  // namespace plab::program
