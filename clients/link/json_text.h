/// Makes text from the bus safe to show, as JSON or on a terminal.
#pragma once

#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace plab::link
{

/// The shortest decimal text that reads back as `value`: "0.1", "inf", "nan".
std::string number_text(double value);
std::string number_text(float value);

/// Bytes that are not valid UTF-8 become U+FFFD.
std::string valid_utf8(std::string_view text);
/// Control characters are written as "\x1b" and the like, so that foreign text cannot control the terminal.
std::string terminal_text(std::string_view text);

/// Quoted and escaped; always valid UTF-8.
std::string json_text(std::string_view text);
/// JSON that another writer made, whose text is valid UTF-8: control characters that it left as they are become "\\u009b".
std::string safe_json(std::string_view json);
/// JSON has no infinities or NaN: they become null.
std::string json_number(double value);
std::string json_number(float value);

/// Writes one JSON document from its parts in order; puts the commas.
///
///   JsonWriter json;
///   json.open('{').key("time").value(0.5).key("names").open('[').value("a").value("b").close(']').close('}');
///   json.take() == R"({"time":0.5,"names":["a","b"]})"
class JsonWriter
{
public:
    JsonWriter& open(char bracket)
    {
        put(std::string_view(&bracket, 1));
        is_first_ = true;
        return *this;
    }
    JsonWriter& close(char bracket)
    {
        text_ += bracket;
        is_first_ = false;
        return *this;
    }
    JsonWriter& key(std::string_view name)
    {
        put(json_text(name) + ":");
        is_first_ = true;
        return *this;
    }
    JsonWriter& value(std::string_view text) { return put(json_text(text)); }
    JsonWriter& value(const char* text) { return put(json_text(text == nullptr ? "" : text)); }
    template <class T>
    requires std::is_arithmetic_v<T> JsonWriter& value(T number)
    {
        if constexpr (std::is_same_v<T, bool>)
            return put(number ? "true" : "false");
        else if constexpr (std::is_floating_point_v<T>)
            return put(json_number(number));
        else
            return put(std::to_string(number));
    }
    /// A value that is JSON already.
    JsonWriter& json(std::string_view ready) { return put(ready); }
    std::string take() { return std::exchange(text_, {}); }

private:
    JsonWriter& put(std::string_view part)
    {
        if (!is_first_) text_ += ',';
        text_ += part;
        is_first_ = false;
        return *this;
    }

    std::string text_;
    bool is_first_ = true;
};

}  // namespace plab::link
