#include <doctest/doctest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "blueprint/reader.h"

using namespace plab;
using blueprint::read_blueprint;
using blueprint::read_blueprint_file;

namespace
{

/// The blueprint, which must be free of errors.
model::Blueprint read(const std::string& text)
{
    auto result = read_blueprint(text, "s.xml");
    REQUIRE_MESSAGE(result.ok(), (result.ok() ? "" : result.error().text()));
    return result.take();
}

std::string place(const SourceLocation& w) { return w.file + ":" + std::to_string(w.line) + ":" + std::to_string(w.column); }

std::string first_error(const std::string& text)
{
    const auto result = read_blueprint(text, "s.xml");
    return result.ok() ? "accepted" : result.error().text();
}

}  // namespace

TEST_CASE("an empty scene is valid")
{
    const auto b = read("<plab version=\"1\"/>");
    CHECK(b.file == "s.xml");
    CHECK(b.components.empty());
    CHECK(place(b.where) == "s.xml:1:1");
}

TEST_CASE("components keep attributes, order, nesting and positions in the text")
{
    const auto b = read(
        "<?xml version='1.0' encoding='utf-8'?>\n"
        "<plab version=' 1 '>\n"
        "  <!-- words -->\n"
        "  <component id=' ball ' name='a ball' type='State/RigidBody' mass='2 kg' position='0 0 1'>\n"
        "    <component id='inner'/><component id='second'><compref> inner </compref></component>\n"
        "    <param name='material'> wood </param>\n"
        "  </component>\n"
        "  <component id='&#x3b1;'/>\n"
        "</plab>\n");
    REQUIRE(b.components.size() == 2);
    const auto& ball = b.components[0];
    CHECK(ball.id == "ball");
    CHECK(ball.name == "a ball");
    CHECK(ball.type == "State/RigidBody");
    CHECK(place(ball.where) == "s.xml:4:3");
    REQUIRE(ball.attributes.size() == 2);
    CHECK(ball.attributes[0].name == "mass");
    CHECK(ball.attributes[0].text == "2 kg");
    CHECK(place(ball.attributes[0].where) == "s.xml:4:3");
    REQUIRE(ball.children.size() == 2);
    CHECK(place(ball.children[1].where) == "s.xml:5:28");
    REQUIRE(ball.children[1].references.size() == 1);
    CHECK(ball.children[1].references[0] == "inner");
    CHECK(place(ball.children[1].reference_places.at(0)) == "s.xml:5:51");
    REQUIRE(ball.parameters.size() == 1);
    CHECK(ball.parameters[0].text == " wood ");
    CHECK(place(ball.parameters[0].where) == "s.xml:6:5");
    CHECK(b.components[1].id == "\xCE\xB1");
}

TEST_CASE("columns count characters, not bytes")
{
    const auto b = read("<plab version='1'><!-- \xC3\xA9\xE2\x82\xAC\xF0\x9F\x8E\x88 --><component id='x'/></plab>");
    CHECK(place(b.components.at(0).where) == "s.xml:1:31");
}

TEST_CASE("scene settings, cameras and repetitions")
{
    const auto b = read(
        "<plab version='1'>\n<scene dt='1/240' title='t'><camera id='main' position='1 2 3'/></scene>\n"
        "<repeat count='3 1 1'><component id='a'/><component id='b'/></repeat></plab>");
    REQUIRE(b.settings.size() == 2);
    CHECK(b.settings[0].name == "dt");
    CHECK(b.settings[0].text == "1/240");
    CHECK(place(b.settings[1].where) == "s.xml:2:1");
    REQUIRE(b.cameras.size() == 1);
    CHECK(b.cameras[0].id == "main");
    CHECK(b.cameras[0].attributes.at(0).text == "1 2 3");
    REQUIRE(b.repeats.size() == 1);
    CHECK(b.repeats[0].attributes.at(0).text == "3 1 1");
    CHECK(b.repeats[0].components.size() == 2);
}

TEST_CASE("states are gathered into one parameter with entries")
{
    const auto b = read(
        "<plab version='1'><component id='s' type='Script/Lua'>\n"
        "<state name='count'>0</state><state name='on'>true</state>\n"
        "<state name='word'>hello</state><state name='digits'>\"12\"</state>\n"
        "<param name='table'><entry name='x'>-1.5e3</entry></param></component></plab>");
    const auto& p = b.components.at(0).parameters;
    REQUIRE(p.size() == 2);
    CHECK(p[0].name == "state");
    CHECK(p[0].entries == Entries{{"count", 0.0}, {"on", true}, {"word", std::string("hello")}, {"digits", std::string("12")}});
    CHECK(place(p[0].where) == "s.xml:2:1");
    CHECK(p[1].entries == Entries{{"x", -1500.0}});
}

TEST_CASE("text of code is kept literally")
{
    const auto b = read(
        "<plab version='1'><component id='s'><param name='code'>\n  if a &lt; b then <![CDATA[x = a < b & "
        "\"c\"]]>\n</param>"
        "</component></plab>");
    CHECK(b.components.at(0).parameters.at(0).text == "\n  if a < b then x = a < b & \"c\"\n");
}

TEST_CASE("figure 2 and 4: exported commands, composites and stage lists")
{
    const auto b = read(
        "<plab version='1'><component id='01'><command id='08' subject='02' type='Shape/Draw'/>"
        "<command id='09' name='O/Simulation'><command name='Stage/Init'><cmdref> 08 </cmdref></command>"
        "<command name='Stage/Step'/></command></component></plab>");
    const auto& commands = b.components.at(0).commands;
    REQUIRE(commands.size() == 2);
    CHECK(commands[0].id == "08");
    CHECK(commands[0].subject == "02");
    CHECK(commands[0].type == "Shape/Draw");
    REQUIRE(commands[1].children.size() == 2);
    CHECK(commands[1].children[0].name == "Stage/Init");
    CHECK(commands[1].children[0].children.at(0).reference == "08");
    CHECK(commands[1].children[1].children.empty());
}

TEST_CASE("figure 6: parameters that follow a command belong to that command")
{
    const auto b = read(
        "<plab version='1'><component id='c'><command name='C/Simulation'><command name='Stage/Step'>\n"
        "<command subject='52' type='Constraint/AngularVelocity'/>\n"
        "<cmdparam type='SetTargetState'><udata><cmdref>202</cmdref></udata></cmdparam>\n"
        "<cmdparam type='SetVelocityFactor'><udata>-0.5</udata></cmdparam>\n"
        "</command></command></component></plab>");
    const auto& stage = b.components.at(0).commands.at(0).children.at(0);
    CHECK(stage.parameters.empty());
    REQUIRE(stage.children.size() == 1);
    const auto& parameters = stage.children[0].parameters;
    REQUIRE(parameters.size() == 2);
    CHECK(parameters[0].name == "SetTargetState");
    CHECK(parameters[0].command_references == std::vector<std::string>{"202"});
    CHECK(parameters[1].text == "-0.5");
    CHECK(place(parameters[1].where) == "s.xml:4:1");
}

TEST_CASE("figure 7: parameters inside a command, and after one in a component")
{
    const auto b = read(
        "<plab version='1'><component id='c'><command id='300' type='Script/Lua'><cmdparam type='SetCode'>"
        "<udata>emit('hello')</udata></cmdparam></command><cmdparam type='SetDriver'><udata><compref>a</compref>"
        "<compref>b c</compref></udata></cmdparam><cmdparam "
        "type='SetX'><udata>1</udata></cmdparam></component></plab>");
    const auto& parameters = b.components.at(0).commands.at(0).parameters;
    REQUIRE(parameters.size() == 3);
    CHECK(parameters[2].text == "1");
    CHECK(parameters[0].text == "emit('hello')");
    CHECK(parameters[1].component_references == std::vector<std::string>{"a", "b c"});
}

TEST_CASE("a fragment may be a single component")
{
    const auto b = read("<component id='new' type='State/Static'><component id='new.shape'/></component>");
    REQUIRE(b.components.size() == 1);
    CHECK(b.components[0].id == "new");
    CHECK(b.components[0].children.size() == 1);
}

TEST_CASE("foreign elements go to their handlers and imply a type")
{
    blueprint::ForeignHandlers handlers;
    handlers.add({"BLOB", "Shape/Blob",
                  [](const blueprint::XmlElement& e) -> Result<std::vector<model::ValueNode>>
                  {
                      if (e.text.empty()) return Error{{{}, e.where.line, e.where.column}, "<BLOB>", "is empty"};
                      return std::vector<model::ValueNode>{{"text", Value(e.text), {{}, e.where.line, e.where.column}}};
                  }});
    const auto good = read_blueprint(
        "<plab version='1'><component id='a'><BLOB>x</BLOB></component>\n"
        "<component id='b' type='Shape/Other'><BLOB>y</BLOB></component></plab>",
        "s.xml", handlers);
    REQUIRE(good.ok());
    CHECK(good->components[0].type == "Shape/Blob");
    CHECK(good->components[1].type == "Shape/Other");
    CHECK(place(good->components[1].values.at(0).where) == "s.xml:2:38");
    const auto bad = read_blueprint("<plab version='1'>\n<component id='a'><BLOB/></component><BLOB>x</BLOB></plab>", "s.xml", handlers);
    REQUIRE(!bad.ok());
    REQUIRE(bad.errors().size() == 2);
    CHECK(bad.errors()[0].text() == "s.xml:2:19: <BLOB>: is empty");
    CHECK(bad.errors()[1].text() == "s.xml:2:38: <BLOB>: is not allowed in <plab>; it belongs in <component>");
}

TEST_CASE("errors are collected as long as the XML is well-formed")
{
    const auto result = read_blueprint("<plab version='2'>\n<sceen/>\n<component id=''>\n text</component>\n<?php x?></plab>", "s.xml");
    REQUIRE(!result.ok());
    std::vector<std::string> texts;
    for (const Error& e : result.errors()) texts.push_back(e.text());
    CHECK(texts == std::vector<std::string>{
                       "s.xml:1:1: <plab>: version '2' is not known; this pLab reads version '1'",
                       "s.xml:2:1: <sceen>: unknown element, did you mean 'scene'?",
                       "s.xml:3:1: <component>: id must not be empty",
                       "s.xml:4:2: <component>: unexpected text 'text'",
                       "s.xml:5:1: <?php?>: processing instructions are not supported",
                   });
}

TEST_CASE("very many errors are counted, not listed")
{
    std::string text = "<plab version='1'>";
    for (int i = 0; i < 250; ++i) text += "<x/>";
    const auto result = read_blueprint(text + "</plab>", "s.xml");
    REQUIRE(!result.ok());
    CHECK(result.errors().size() == 101);
    CHECK(result.errors().back().text() == "s.xml: 150 more errors are not shown");
}

TEST_CASE("files: one that is read, a missing one, a folder")
{
    const std::string path = (std::filesystem::temp_directory_path() / "plab_reader_test.xml").string();
    std::ofstream(path) << "<plab version='1'>\n<component id='f'/></plab>";
    const auto good = read_blueprint_file(path);
    std::remove(path.c_str());
    REQUIRE(good.ok());
    CHECK(good->components.at(0).where.file == path);
    CHECK(good->components.at(0).where.line == 2);

    const auto missing = read_blueprint_file(path);
    REQUIRE(!missing.ok());
    CHECK(missing.error().text() == path + ": cannot be opened: No such file or directory");
    const auto folder = read_blueprint_file(std::filesystem::temp_directory_path().string());
    REQUIRE(!folder.ok());
    CHECK(folder.error().reason == "cannot be read: Is a directory");
}

TEST_CASE("for misplaced words the message says where they belong")
{
    const auto in_component = [](const std::string& inner)
    { return first_error("<plab version='1'><component id='a'>" + inner + "</component></plab>"); };
    CHECK(in_component("<scene/>") == "s.xml:1:37: <scene>: is not allowed in <component>; it belongs in <plab>");
    CHECK(in_component("<cmdparam type='SetX'/>") ==
          "s.xml:1:37: <cmdparam>: is not allowed in <component>; it belongs in <command>, or right after one");
    CHECK(in_component("<plab/>") == "s.xml:1:37: <plab>: is not allowed in <component>; it is the root element");
    CHECK(first_error("<plab version='1'><command/></plab>") ==
          "s.xml:1:19: <command>: is not allowed in <plab>; it belongs in <component> or <command>");
}
