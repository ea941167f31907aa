/// Reads Prometheus' text format, version 0.0.4, and accepts nothing that its description does not: a test's own reader, for Debian's
/// promtool brings 96 MB.
#pragma once

#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace plab::test::prometheus
{

struct Series
{
    std::map<std::string, std::string> labels;
    double value = 0;
};
struct Family
{
    std::string type, help;
    std::vector<Series> series;
};

class Reader
{
public:
    /// Empty, and error() says where: the text breaks a rule.
    std::map<std::string, Family> read(const std::string& text)
    {
        if (text.empty() || text.back() != '\n') return fail("the last line does not end");
        std::istringstream in(text);
        for (std::string line; error_.empty() && std::getline(in, line);)
        {
            ++line_;
            if (line.starts_with("# "))
                comment(line.substr(2));
            else
                sample(line);
        }
        if (!error_.empty()) families_.clear();
        return families_;
    }
    const std::string& error() const { return error_; }

private:
    std::map<std::string, Family> fail(const std::string& what)
    {
        if (error_.empty()) error_ = "line " + std::to_string(line_) + ": " + what;
        return {};
    }
    static bool is_name(const std::string& text, bool is_label)
    {
        if (text.empty() || (text[0] >= '0' && text[0] <= '9')) return false;
        for (const char c : text)
            if (!(std::isalnum(static_cast<unsigned char>(c)) || c == '_' || (c == ':' && !is_label))) return false;
        return true;
    }
    /// HELP before TYPE, each once, and both before the samples.
    void comment(const std::string& text)
    {
        std::istringstream words(text);
        std::string kind, name, rest;
        words >> kind >> name;
        std::getline(words >> std::ws, rest);
        if (!is_name(name, false)) return (void)fail("no name of a metric: " + name);
        if (kind == "HELP")
        {
            if (families_.contains(name)) return (void)fail(name + " comes twice");
            families_[name].help = rest;
            if (rest.empty()) return (void)fail(name + " has no help");
            current_ = name;
        }
        else if (kind == "TYPE")
        {
            static const std::set<std::string> types{"counter", "gauge", "histogram", "summary", "untyped"};
            if (name != current_ || !families_[name].type.empty()) return (void)fail("TYPE of " + name + " is not behind its HELP");
            if (!types.contains(rest)) return (void)fail("there is no type " + rest);
            if ((rest == "counter") != name.ends_with("_total")) return (void)fail(name + ": counters, and they alone, end with _total");
            families_[name].type = rest;
        }
        else
            fail("a comment that is neither HELP nor TYPE");
    }
    void sample(const std::string& line)
    {
        std::size_t at = line.find_first_of("{ ");
        if (at == std::string::npos) return (void)fail("a sample without a value");
        const std::string name = line.substr(0, at);
        if (name != current_ || families_[name].type.empty()) return (void)fail("a sample of " + name + " is not below its TYPE");
        Series out;
        if (line[at] == '{' && !labels(line, at, out.labels)) return;
        if (at >= line.size() || line[at] != ' ') return (void)fail("no space before the value");
        const std::string value = line.substr(at + 1);
        static const std::map<std::string, double> words{{"NaN", NAN}, {"+Inf", INFINITY}, {"-Inf", -INFINITY}};
        char* end = nullptr;
        out.value = words.contains(value) ? words.at(value) : std::strtod(value.c_str(), &end);
        const bool is_number = !value.empty() && value.find_first_not_of("0123456789+-.e") == std::string::npos && end == &*value.end();
        if (!words.contains(value) && !is_number) return (void)fail("no number: " + value);
        for (const Series& other : families_[name].series)
            if (other.labels == out.labels) return (void)fail(name + " has two samples with the same labels");
        if (families_[name].type == "counter" && !(out.value >= 0)) return (void)fail(name + " is a counter below zero");
        families_[name].series.push_back(std::move(out));
    }
    bool labels(const std::string& line, std::size_t& at, std::map<std::string, std::string>& out)
    {
        for (++at; at < line.size() && line[at] != '}';)
        {
            const std::size_t equals = line.find("=\"", at);
            if (equals == std::string::npos || !is_name(line.substr(at, equals - at), true)) return fail("no label"), false;
            const std::string label = line.substr(at, equals - at);
            std::string value;
            for (at = equals + 2; at < line.size() && line[at] != '"'; ++at)
            {
                if (line[at] != '\\')
                {
                    value += line[at];
                    continue;
                }
                const char escaped = ++at < line.size() ? line[at] : ' ';
                if (escaped != 'n' && escaped != '"' && escaped != '\\') return fail("an escape that there is not"), false;
                value += escaped == 'n' ? '\n' : escaped;
            }
            if (at >= line.size() || !out.emplace(label, value).second) return fail("labels of " + line), false;
            ++at;
            if (at < line.size() && line[at] == ',') ++at;
        }
        if (at >= line.size()) return fail("labels do not end"), false;
        ++at;
        return true;
    }

    std::map<std::string, Family> families_;
    std::string current_, error_;
    int line_ = 0;
};

}  // namespace plab::test::prometheus
