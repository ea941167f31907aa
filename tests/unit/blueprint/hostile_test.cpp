/// Input that is made to break the reader: each case quickly ends in an error with its own message.
#include <doctest/doctest.h>

#include <chrono>

#include "blueprint/reader.h"

using namespace plab;
using namespace std::string_view_literals;

namespace
{

std::string blueprint_refusal(std::string_view text)
{
    const auto result = blueprint::read_blueprint(text, "h.xml");
    return result.ok() ? "accepted" : result.error().text();
}

std::string repeated(std::string_view part, std::size_t n)
{
    std::string out;
    out.reserve(part.size() * n);
    for (std::size_t i = 0; i < n; ++i) out += part;
    return out;
}

/// Far above what is needed (some 10 ms), for sanitizers and busy machines; far below what a quadratic answer takes.
constexpr double kQuickly = 3.0;  // s

double seconds_for(const std::string& text)
{
    const auto begin = std::chrono::steady_clock::now();
    (void)blueprint::read_blueprint(text, "h.xml");
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

TEST_CASE("the billion-laughs attack stops at the first entity")
{
    std::string text = "<?xml version='1.0'?>\n<!DOCTYPE lolz [\n<!ENTITY lol 'lol'>\n";
    for (int i = 1; i < 10; ++i)
    {
        const std::string before = i == 1 ? "&lol;" : "&lol" + std::to_string(i - 1) + ";";
        text += "<!ENTITY lol" + std::to_string(i) + " '" + repeated(before, 10) + "'>\n";
    }
    text += "]>\n<plab version='1'><component id='&lol9;'/></plab>";
    CHECK(blueprint_refusal(text) == "h.xml:2:1: DOCTYPE: a document type (DTD) is not supported: a blueprint has no entities");
    CHECK(seconds_for(text) < 0.5);
}

TEST_CASE("external entities are not read")
{
    CHECK(blueprint_refusal("<!DOCTYPE plab SYSTEM 'file:///etc/passwd'><plab version='1'/>") ==
          "h.xml:1:1: DOCTYPE: a document type (DTD) is not supported: a blueprint has no entities");
    CHECK(blueprint_refusal("<plab version='1'>&passwd;</plab>") ==
          "h.xml:1:19: not well-formed XML: unknown entity; only &lt; &gt; &amp; &quot; &apos; and character numbers "
          "are known");
}

TEST_CASE("depth: 64 elements may be open, the 65th may not")
{
    const auto nested = [](std::size_t n)
    { return "<plab version='1'>" + repeated("<component>", n) + repeated("</component>", n) + "</plab>"; };
    CHECK(blueprint_refusal(nested(63)) == "accepted");
    CHECK(blueprint_refusal(nested(64)) == "h.xml:1:712: <component>: elements are nested more than 64 deep");
    CHECK(blueprint_refusal("<plab version='1'>" + repeated("<component>", 100'000)) ==
          "h.xml:1:712: <component>: elements are nested more than 64 deep");
    const auto result = blueprint::read_blueprint(repeated("<a>", 100'000), "h.xml");
    REQUIRE(!result.ok());
    CHECK(result.errors().back().text() == "h.xml:1:193: <a>: elements are nested more than 64 deep");
}

TEST_CASE("names: 200 characters, not more")
{
    const std::string longest(200, 'n'), endless(1'000'000, 'n');
    CHECK(blueprint_refusal("<plab version='1'><component id='" + longest + "' " + longest + "='1'/></plab>") == "accepted");
    CHECK(blueprint_refusal("<plab version='1'><" + longest + "n/></plab>") ==
          "h.xml:1:19: the name of an element has 201 characters; at most 200 are allowed");
    CHECK(blueprint_refusal("<plab version='1'><" + endless + "/></plab>") ==
          "h.xml:1:19: the name of an element has 1000000 characters; at most 200 are allowed");
    CHECK(blueprint_refusal("<plab version='1'><component " + endless + "='1'/></plab>") ==
          "h.xml:1:19: <component>: the name of an attribute has more than 200 characters");
    CHECK(blueprint_refusal("<plab version='1'><component id='" + endless + "'/></plab>") ==
          "h.xml:1:19: <component>: id has 1000000 characters; at most 200 are allowed");
    CHECK(blueprint_refusal("<plab version='1'><component><compref>" + endless + "</compref></component></plab>") ==
          "h.xml:1:30: <compref>: the id has 1000000 characters; at most 200 are allowed");
    const std::string quoted = blueprint_refusal("<plab version='1'>" + endless + "</plab>");
    CHECK(quoted.size() < 200);
}

TEST_CASE("attributes: 64 per element, not more")
{
    const auto with = [](std::size_t n)
    {
        std::string text = "<plab version='1'><component";
        for (std::size_t i = 0; i < n; ++i) text += " a" + std::to_string(i) + "='1'";
        return text + "/></plab>";
    };
    CHECK(blueprint_refusal(with(64)) == "accepted");
    CHECK(blueprint_refusal(with(65)) == "h.xml:1:19: <component>: more than 64 attributes");
    CHECK(blueprint_refusal(with(100'000)) == "h.xml:1:19: <component>: more than 64 attributes");
}

TEST_CASE("sizes of text, of values, of the whole, and the number of elements")
{
    const std::string head = "<plab version='1'><component id='a'><param name='p'>";
    const std::string tail = "</param></component></plab>";
    const std::size_t most = std::size_t{16} << 20;
    CHECK(blueprint_refusal(head + std::string(most, 'x') + tail) == "accepted");
    CHECK(blueprint_refusal(head + std::string(most + 1, 'x') + tail) == "h.xml:1:53: <param>: the text is longer than 16777216 bytes");
    CHECK(blueprint_refusal("<plab version='1'><component x='" + std::string(most + 1, 'x') + "'/></plab>") ==
          "h.xml:1:19: <component>: the value of attribute 'x' is longer than 16777216 bytes");
    CHECK(blueprint_refusal(std::string((std::size_t{64} << 20) + 1, ' ')) == "h.xml: the text is larger than 67108864 bytes");
    CHECK(blueprint_refusal("<plab version='1'>" + repeated("<a/>", 2'000'000) + "</plab>") ==
          "h.xml:1:19: <a>: unknown element");  // the first of the collected ones; the limit is the last
    blueprint::XmlLimits few;
    few.elements = 2;
    const auto result = blueprint::read_blueprint("<component><component/><component/></component>", "h.xml", {}, few);
    REQUIRE(!result.ok());
    CHECK(result.error().text() == "h.xml:1:24: more than 2 elements");
}

TEST_CASE("encodings other than UTF-8 are refused where they are declared")
{
    CHECK(blueprint_refusal("<?xml version='1.0' encoding='ISO-8859-1'?><plab version='1'/>") ==
          "h.xml:1:1: <?xml?>: encoding 'ISO-8859-1' is not supported; a blueprint must be UTF-8");
    CHECK(blueprint_refusal("\xFF\xFE<\0p\0"sv) == "h.xml:1:1: the text is UTF-16; a blueprint must be UTF-8");
    CHECK(blueprint_refusal("<\0p\0l\0"sv) == "h.xml:1:2: a NUL character is not allowed in XML");
    CHECK(blueprint_refusal("\xEF\xBB\xBF<plab version='1'/>") == "accepted");
}

TEST_CASE("bytes that are not UTF-8")
{
    const auto with = [](std::string_view bytes)
    { return blueprint_refusal("<plab version='1'>\n<!--a" + std::string(bytes) + "--></plab>"); };
    const std::string at = "h.xml:2:6: the text is not valid UTF-8";
    CHECK(with("\x80") == at);                  // a continuation alone
    CHECK(with("\xC0\xAF") == at);              // overlong '/'
    CHECK(with("\xE0\x80\xAF") == at);          // overlong in three bytes
    CHECK(with("\xF0\x80\x80\xAF") == at);      // in four
    CHECK(with("\xED\xA0\x80") == at);          // a surrogate
    CHECK(with("\xF4\x90\x80\x80") == at);      // beyond U+10FFFF
    CHECK(with("\xF8\x88\x80\x80\x80") == at);  // five bytes
    CHECK(with("\xE2\x82") == at);              // cut short
    CHECK(with("\xF4\x8F\xBF\xBD") == "accepted");
    CHECK(blueprint_refusal("<plab version='1'/>\xC3") == "h.xml:1:20: the text is not valid UTF-8");
}

TEST_CASE("NUL and other characters that XML does not have")
{
    CHECK(blueprint_refusal("<plab version='1'>\n a\0b</plab>"sv) == "h.xml:2:3: a NUL character is not allowed in XML");
    CHECK(blueprint_refusal("<plab version='1'>\x01</plab>") == "h.xml:1:19: not well-formed XML: not well-formed (invalid token)");
    CHECK(blueprint_refusal("<plab version='1'>&#0;</plab>") == "h.xml:1:19: not well-formed XML: reference to invalid character number");
}

TEST_CASE("incomplete XML")
{
    CHECK(blueprint_refusal("") == "h.xml:1:1: not well-formed XML: the document has no elements");
    CHECK(blueprint_refusal("<plab version='1'>\n<component>\n") ==
          "h.xml:3:1: not well-formed XML: <component> of line 2 is never closed");
    CHECK(blueprint_refusal("<plab version='1'>\n<component>\n</plab>") ==
          "h.xml:3:3: not well-formed XML: a closing tag that does not match the open <component> of line 2");
    CHECK(blueprint_refusal("<plab version='1'/><plab/>") == "h.xml:1:20: not well-formed XML: there is content after the root element");
    CHECK(blueprint_refusal("<plab version='1' version='1'/>") == "h.xml:1:19: not well-formed XML: duplicate attribute");
    CHECK(blueprint_refusal("<plab version=1/>") == "h.xml:1:15: not well-formed XML: not well-formed (invalid token)");
    CHECK(blueprint_refusal("<plab version='1'><![CDATA[") == "h.xml:1:28: not well-formed XML: unclosed CDATA section");
}

TEST_CASE("a document cut at any byte or with any byte changed gives a result or an error")
{
    const std::string good =
        "<?xml version='1.0'?><plab version='1'><scene dt='1/60'/><component id='m'><MESH><P ID='1'>0,0,0</P><P "
        "ID='2'>1,0,0</P>"
        "<P ID='3'>0,1,0</P><F><FV1><PREF>1</PREF></FV1><FV2><PREF>2</PREF></FV2><FV3><PREF>3</PREF></FV3></F></MESH>"
        "<command><cmdparam type='SetX'><udata>1</udata></cmdparam></command><state "
        "name='a'>1</state></component></plab>";
    REQUIRE(blueprint_refusal(good) == "accepted");
    std::size_t refused = 0;
    for (std::size_t n = 0; n < good.size(); ++n) refused += blueprint_refusal(good.substr(0, n)) != "accepted";
    CHECK(refused == good.size());
    for (std::size_t i = 0; i < good.size(); ++i)
        for (const char c : {'\0', '<', '>', '"', '&', '\xC3', ' ', '9'})
        {
            std::string changed = good;
            changed[i] = c;
            CHECK(!blueprint_refusal(changed).empty());
        }
}

TEST_CASE("large and unusual input is handled quickly")
{
    CHECK(seconds_for("<plab version='1'>" + repeated("<x/>", 100'000) + "</plab>") < kQuickly);
    CHECK(seconds_for(repeated("<?x?>", 1'000'000)) < kQuickly);
    CHECK(seconds_for("<plab version='1'>" + repeated("&amp;", 1'000'000) + "</plab>") < kQuickly);
    CHECK(seconds_for("<plab version='1'><component>" + repeated("<state name='s'>1</state>", 100'000) + "</component></plab>") < kQuickly);
    CHECK(blueprint_refusal(repeated("<?x?>", 1'000)) == "h.xml:1:1: <?x?>: processing instructions are not supported");
}
