// Types from the IDL that a recording contains.
#include <doctest/doctest.h>

#include "control/recordings/schema.h"
#include "idl/recording/topic_schema.h"

using namespace plab;
using namespace plab::recordings;
using Kind = link::DynamicType::Kind;

TEST_CASE("every topic of the wire is understood")
{
    for (const wire::Topic& topic : wire::topics())
    {
        const auto schema = recording::schema_of(topic);
        REQUIRE(schema.ok());
        const auto type = type_of(*schema);
        REQUIRE_MESSAGE(type.ok(), topic.name);
        CHECK((*type)->name == topic.type->m_typename);
        CHECK(!(*type)->members.empty());
    }
}

TEST_CASE("sequences, arrays, bounds, typedefs, enums, bases, keys")
{
    const auto type = type_in(R"(module a { // a comment
        typedef octet Id[16]; /* and another */
        enum Color { RED, GREEN };
        @nested struct Base { unsigned long long n; };
        module b {
          @final struct T : Base {
            @key string<8> name; sequence<double, 3> values; Id id; Color color; long grid[2][3], one; a::Base base;
          };
        };
      };)",
                              "a::b::T");
    REQUIRE_MESSAGE(type.ok(), type.error().text());
    const auto& m = (*type)->members;
    REQUIRE(m.size() == 8);
    CHECK(m[0].name == "n");
    CHECK(m[0].type->kind == Kind::Uint64);
    CHECK(m[1].is_key);
    CHECK(m[1].type->bound == 8);
    CHECK(m[2].type->kind == Kind::Sequence);
    CHECK(m[2].type->bound == 3);
    CHECK(m[2].type->element->kind == Kind::Float64);
    CHECK(m[3].type->dimensions == std::vector<std::uint32_t>{16});
    CHECK(m[4].type->literals.at(1) == std::pair<std::int32_t, std::string>{1, "GREEN"});
    CHECK(m[5].type->dimensions == std::vector<std::uint32_t>{2, 3});
    CHECK(m[6].type->kind == Kind::Int32);
    CHECK(m[7].type->name == "a::Base");
}

TEST_CASE("text that is not understood is an error, whatever it is")
{
    const auto why = [](const std::string& idl) { return type_in(idl, "T").error().text(); };
    CHECK(why("struct T { Unknown x; };").find("'Unknown' is not declared before it is used") != std::string::npos);
    CHECK(why("struct S { long x; };").find("does not declare T") != std::string::npos);
    CHECK(why("union T switch (long) { case 1: long x; };").find("'union'") != std::string::npos);
    CHECK(why("struct T { @optional long x; };").find("@optional") != std::string::npos);
    CHECK(why("struct T { long x }").find("';' is missing") != std::string::npos);
    CHECK(why("} ;").find("a '}' too many") != std::string::npos);
    CHECK(why("struct T { sequence<long, many> x; };").find("'many' is not a number") != std::string::npos);
    std::string deep = "struct T { ";
    for (int i = 0; i < 1000; ++i) deep += "sequence<";
    CHECK(why(deep).find("nested too deeply") != std::string::npos);
    const std::string whole = recording::idl_of("plab::v2::Frame").take();
    REQUIRE(whole.ends_with("};\n"));
    for (std::size_t n = 0; n < whole.size() - 1; ++n) CHECK(!type_in(whole.substr(0, n), "plab::v2::Frame").ok());
}
