/// Commands: what they export, what they set, and what a simulation command selects.
#include <doctest/doctest.h>

#include "scene_types.h"

using namespace plab;
using namespace plab::test;
using model::CommandNode;
using model::ComponentNode;

namespace
{

ComponentNode with_commands(ComponentNode node, std::vector<CommandNode> commands)
{
    node.commands = std::move(commands);
    return node;
}

/// A command of its own id with cmdparams.
CommandNode setting(CommandNode node, std::vector<model::TextNode> parameters)
{
    node.parameters = std::move(parameters);
    return node;
}

CommandNode with_id(std::string id, CommandNode node)
{
    node.id = std::move(id);
    return node;
}

/// "sim": a simulation command of the given stages.
CommandNode simulation_command(std::vector<CommandNode> stages) { return composite("sim", "Test/Simulation", std::move(stages), 20); }
CommandNode stage(const char* name, std::vector<CommandNode> list, std::uint32_t line = 21)
{
    return composite("", std::string("Stage/") + name, std::move(list), line);
}

/// A gear and its shafts, where the group "i" has the simulation command.
std::vector<ComponentNode> gear_scene(std::vector<CommandNode> stages)
{
    return {shaft("a"), shaft("b"), component("g", "Constraint/AngularVelocity/Graph", {{"driver", "a"}, {"driven", "b"}}),
            with_commands(group("i", {component("form", "Shape/Sphere")}), {simulation_command(std::move(stages))})};
}

std::string gear_errors(std::vector<CommandNode> stages) { return errors_of(gear_scene(std::move(stages))); }

}  // namespace

TEST_CASE("the paper's figure 6: a gear that a stage list sets up")
{
    const CommandNode couple =
        setting(command("52", "Constraint/AngularVelocity"),
                {command_reference("SetTargetState", {"202"}), reference("SetSourceState", {"a"}), text("SetVelocityFactor", "-0.5")});
    const model::SceneSpec s = compiled(scene({
        shaft("a"),
        with_commands(group("wheel", {shaft("b")}), {with_id("202", command("b", "State/Restore"))}),
        component("52", "Constraint/AngularVelocity/Graph"),
        with_commands(group("00", {}), {composite("01", "ExampleConstraint/Simulation", {stage("Step", {couple})})}),
    }));
    CHECK(role_of(s, "52", "driver") == "a");
    CHECK(role_of(s, "52", "driven") == "b");
    CHECK(field_of(s, "52", "velocity_factor") == "-0.5");
    CHECK(commands_of(s, "52") == "Constraint/AngularVelocity");
}

TEST_CASE("a cmdref stands for the subject of its command")
{
    const auto gear_set_by = [](const char* cmdref)
    {
        const CommandNode export_gear = setting(command("g", "Constraint/AngularVelocity", 8),
                                                {command_reference("SetTargetState", {cmdref}, 9), reference("SetSourceState", {"a"}, 9)});
        ComponentNode interface = with_commands(group("i", {}), {with_id("202", command("same", "Constraint/Finish", 5)), export_gear,
                                                                 composite("203", "list", {see_command("202", 7)}, 6)});
        return std::vector<ComponentNode>{shaft("a"), shares("same", {"b"}), shaft("b"), component("g", "Constraint/AngularVelocity/Graph"),
                                          interface};
    };
    // A shaft exports nothing here: the reference is resolved nevertheless.
    CHECK(errors_of(gear_set_by("202")) ==
          "scene.xml:5:1: command 202 (Constraint/Finish): State/Shaft has no command 'Constraint/Finish' (it has "
          "'State/Restore')");
    CHECK(errors_of(gear_set_by("203"))
              .find("scene.xml:9:1: g (Constraint/AngularVelocity/Graph): cmdref: command '203' is a composite and has "
                    "no subject") != std::string::npos);
    CHECK(errors_of(gear_set_by("204")).find("cmdref: no command has the id '204'") != std::string::npos);
}

TEST_CASE("cmdparams set fields and roles by the paper's names")
{
    const CommandNode couple =
        setting(command("g", "Constraint/AngularVelocity"), {reference("SetTargetState", {"b"}), reference("SetSourceState", {"a"}),
                                                             text("SetVelocityFactor", "-0.5"), text("SetMesh", "belt")});
    const model::SceneSpec s =
        compiled(scene({shaft("a"), shaft("b"), with_commands(component("g", "Constraint/AngularVelocity/Graph"), {couple})}));
    CHECK(role_of(s, "g", "driver") == "a");
    CHECK(role_of(s, "g", "driven") == "b");
    CHECK(field_of(s, "g", "velocity_factor") == "-0.5");
    CHECK(commands_of(s, "g") == "defaults");

    // Where no role is called driven, the target takes the only role that it fits.
    const CommandNode run = setting(command("s", "Script/Lua/Force"), {reference("SetTargetState", {"b"}), text("SetCode", "x")});
    CHECK(role_of(compiled(scene({shaft("b"), with_commands(component("s", "Script/Lua"), {run})})), "s", "target") == "b");

    const CommandNode wrong = setting(command("g", "Constraint/AngularVelocity", 5), {text("SetVelocityFacter", "1", 6)});
    CHECK(errors_of({shaft("a"), shaft("b"),
                     with_commands(component("g", "Constraint/AngularVelocity/Graph", {{"driver", "a"}, {"driven", "b"}}), {wrong})}) ==
          "scene.xml:6:1: g (Constraint/AngularVelocity/Graph): unknown parameter 'SetVelocityFacter', did you mean "
          "'SetVelocityFactor'? (known are "
          "'SetVelocityFactor', 'SetMesh', 'SetDriver' and 'SetDriven')");
    const CommandNode twice = setting(command("g", "Constraint/AngularVelocity", 5), {text("SetVelocityFactor", "1", 6)});
    CHECK(errors_of({shaft("a"), shaft("b"),
                     with_commands(component("g", "Constraint/AngularVelocity/Graph",
                                             {{"driver", "a"}, {"driven", "b"}, {"velocity_factor", "2"}}, 3),
                                   {twice})}) ==
          "scene.xml:6:1: g (Constraint/AngularVelocity/Graph): velocity_factor is given twice, here and at "
          "scene.xml:3:1");
}

TEST_CASE("cmdparams reach sub-components that the short form created")
{
    const CommandNode respond = setting(command("c.response", "Response/Respond"), {text("SetRestitution", "0.25")});
    const auto body = [](const char* id) { return component(id, "State/RigidBody", {{"mass", "1"}}); };
    const model::SceneSpec s =
        compiled(scene({body("a"), body("b"), with_commands(component("c", "CDetection/Simple", {{"between", "*"}}), {respond})}));
    CHECK(field_of(s, "c.response", "restitution") == "0.25");
}

TEST_CASE("the paper's figure 7: a command that is a component of its own")
{
    CommandNode hello = setting(with_id("300", command("", "Script/Lua", 4)), {text("SetCode", "print('Hello pLab!')")});
    hello.name = "Hello";
    model::SceneSpec s = compiled(scene({with_commands(group("object", {}), {hello})}));
    REQUIRE(s.find("300"));
    CHECK(s.find("300")->type == "Script/Lua");
    CHECK(s.find("300")->name == "Hello");
    CHECK(s.find("300")->parent == "object");
    CHECK(s.find("300")->generated);
    CHECK(field_of(s, "300", "code") == "print('Hello pLab!')");
    CHECK(commands_of(s, "300") == "defaults");

    s = compiled(scene({with_commands(group("object", {}), {simulation_command({stage("PreStep", {hello})})})}));
    CHECK(commands_of(s, "300") == "Script/Prepare Script/Lua/Drive");
    s = compiled(scene({with_commands(group("object", {}), {hello, simulation_command({stage("Step", {see_command("300")})})})}));
    CHECK(commands_of(s, "300") == "Script/Prepare Script/Lua/Force");
    CHECK(errors_of({with_commands(group("object", {}), {simulation_command({stage("Rewind", {hello})})})}) ==
          "scene.xml:4:1: command 300 (Script/Lua): does no work in Stage/Rewind");
    hello.id.clear();
    CHECK(errors_of({with_commands(group("object", {}), {hello})}) == "scene.xml:4:1: component (Script/Lua): needs an id");
}

TEST_CASE("a simulation command selects exactly what it lists")
{
    const model::SceneSpec s =
        compiled(scene(gear_scene({stage("Init", {command("g", "Constraint/Prepare")}), stage("PreStep", {}),
                                   stage("Step", {command("g", "Constraint/AngularVelocity")}), stage("Deinit", {})})));
    CHECK(commands_of(s, "g") == "Constraint/Prepare Constraint/AngularVelocity");
    CHECK(commands_of(s, "form") == "");
    CHECK(commands_of(s, "a") == "defaults");
}

TEST_CASE("sub-components that the author did not write keep their defaults")
{
    const auto body = [](const char* id) { return component(id, "State/RigidBody", {{"mass", "1"}}); };
    const CommandNode run = simulation_command({stage("PostStep", {command("c", "CDetection/Handle")})});
    const model::SceneSpec s =
        compiled(scene({body("a"), body("b"), with_commands(component("c", "CDetection/Simple", {{"between", "a b"}}), {run})}));
    CHECK(commands_of(s, "c") == "CDetection/Handle");
    CHECK(commands_of(s, "c.response") == "defaults");
}

TEST_CASE("composites are expanded in place")
{
    const model::SceneSpec s = compiled(scene({
        shaft("a"),
        shaft("b"),
        component("g", "Constraint/AngularVelocity/Graph", {{"driver", "a"}, {"driven", "b"}}),
        with_commands(group("i", {}), {composite("both", "Both", {command("g", "Constraint/Finish"), command("f", "Shape/Draw")}),
                                       simulation_command({stage("PostStep", {see_command("both")})})}),
        component("f", "Shape/Sphere"),
    }));
    CHECK(commands_of(s, "g") == "Constraint/Finish");
    CHECK(commands_of(s, "f") == "Shape/Draw");
}

TEST_CASE("a command is found by a prefix that matches one command of its stage")
{
    const model::SceneSpec s = compiled(scene({with_commands(component("s", "Script/Lua", {{"code", "x"}}),
                                                             {simulation_command({stage("Step", {command("s", "Script/Lua")})})})}));
    CHECK(commands_of(s, "s") == "Script/Lua/Force");
    CHECK(errors_of({with_commands(component("s", "Script/Lua", {{"code", "x"}}), {command("s", "Script/Lua", 4)})}) ==
          "scene.xml:4:1: command Script/Lua: 'Script/Lua' could be 'Script/Lua/Drive' or 'Script/Lua/Force': name one "
          "of them");
}

TEST_CASE("the subject can be an object that holds one component with the command")
{
    const auto draw = [](std::vector<ComponentNode> parts)
    { return std::vector<ComponentNode>{with_commands(group("ball", std::move(parts)), {command("ball", "Shape/Draw", 4)})}; };
    CHECK(errors_of(draw({component("f", "Shape/Sphere"), shaft("s")})).empty());
    CHECK(errors_of(draw({shaft("s")})) ==
          "scene.xml:4:1: command Shape/Draw: subject 'ball' holds no component with a command 'Shape/Draw'");
    CHECK(errors_of(draw({component("f", "Shape/Sphere"), component("e", "Shape/Sphere")})) ==
          "scene.xml:4:1: command Shape/Draw: subject 'ball' holds several components with that command ('e' and 'f'): "
          "name one of them");
}

TEST_CASE("commands that do not exist")
{
    const auto why = [](CommandNode node) { return errors_of({with_commands(component("f", "Shape/Sphere"), {std::move(node)})}); };
    CHECK(why(command("f", "Shape/Drw", 4)) ==
          "scene.xml:4:1: command Shape/Drw: Shape/Sphere has no command 'Shape/Drw', did you mean 'Shape/Draw'? (it "
          "has 'Shape/Prepare', "
          "'Shape/VolumeIntegration' and 'Shape/Draw')");
    CHECK(why(command("", "Shape/Draw", 4)).empty());
    CHECK(why(command("ff", "Shape/Draw", 4)) ==
          "scene.xml:4:1: command Shape/Draw: subject: no component has the id 'ff', did you mean 'f'?");
    CHECK(why(composite("x", "Empty", {}, 4)) == "scene.xml:4:1: command x (Empty): needs a type, or commands in it");
    CHECK(why(composite("x", "List", {see_command("y", 5)}, 4)) == "scene.xml:5:1: command: cmdref: no command has the id 'y'");
    CHECK(errors_of({with_commands(group("o", {}), {command("", "Shape/Draw", 4)})}) ==
          "scene.xml:4:1: command Shape/Draw: needs a subject: the id of the component that it acts on");
    CHECK(errors_of({with_commands(component("f", "Shape/Sphere"),
                                   {with_id("1", command("f", "Shape/Draw", 4)), with_id("1", command("f", "Shape/Draw", 5))})}) ==
          "scene.xml:5:1: command 1 (Shape/Draw): command id '1' is already used at scene.xml:4:1");
    CommandNode typed = command("f", "Shape/Draw", 4);
    typed.children = {command("f", "Shape/Draw", 5)};
    CHECK(why(typed) == "scene.xml:4:1: command Shape/Draw: has a type, so it cannot have commands in it");
    CommandNode list = composite("x", "List", {command("f", "Shape/Draw", 5)}, 4);
    CHECK(why(setting(list, {text("SetX", "1")})) ==
          "scene.xml:4:1: command x (List): a composite has no parameters: set them on the subjects of its parts");
    list.subject = "f";
    CHECK(why(list) == "scene.xml:4:1: command x (List): a composite has no subject: its parts have one each");
}

TEST_CASE("component and command ids are two name spaces")
{
    CHECK(errors_of({with_commands(component("01", "Shape/Sphere"), {with_id("01", command("01", "Shape/Draw"))})}).empty());
}

TEST_CASE("stage lists that cannot be executed")
{
    CHECK(gear_errors({stage("Stp", {}, 22)}) ==
          "scene.xml:22:1: command Stage/Stp: unknown stage 'Stage/Stp', did you mean 'Stage/Step'? (stages are "
          "'Stage/Init', 'Stage/PreStep', "
          "'Stage/Step', 'Stage/PostStep', 'Stage/Rewind' and 'Stage/Deinit')");
    CHECK(gear_errors({stage("Step", {}, 22), stage("Step", {}, 23)}) ==
          "scene.xml:23:1: command Stage/Step: stage 'Stage/Step' is given twice");
    CHECK(gear_errors({stage("Step", {}), command("g", "Constraint/Finish", 22)}) ==
          "scene.xml:22:1: command Constraint/Finish: a simulation command can contain only stages (Stage/Init, "
          "Stage/PreStep, ...)");
    CHECK(gear_errors({stage("Step", {command("g", "Constraint/Finish", 22)})}) ==
          "scene.xml:22:1: command Constraint/Finish: 'Constraint/Finish' belongs to Stage/PostStep, not to "
          "Stage/Step: the step runs it in its "
          "phase 'finish'");
    CHECK(gear_errors({stage("Deinit", {command("g", "Constraint/Finish", 22)})}).find("belongs to Stage/PostStep, not to Stage/Deinit") !=
          std::string::npos);
    CHECK(gear_errors({stage("PostStep", {command("form", "Shape/Draw", 22), command("g", "Constraint/Finish", 23)})}) ==
          "scene.xml:23:1: command Constraint/Finish: comes after 'Shape/Draw' (phase 'draw'), but the step runs its "
          "phase 'finish' first: put "
          "it before");
    CHECK(gear_errors({stage("PostStep", {command("g", "Constraint/Finish", 22), command("form", "Shape/Draw", 23)})}).empty());
    CHECK(gear_errors({stage("PostStep", {command("g", "Constraint/Finish", 22), command("g", "Constraint/Finish", 23)})}) ==
          "scene.xml:23:1: command Constraint/Finish: 'Constraint/Finish' of 'g' is in the list twice");
    CHECK(gear_errors({stage("Step", {see_command("none", 22)})}) == "scene.xml:22:1: command: cmdref: no command has the id 'none'");
    CHECK(gear_errors({stage("Step", {see_command("sim", 22)})}).find("a stage can only be part of a simulation command") !=
          std::string::npos);
    CHECK(gear_errors({stage("Step", {composite("", "Stage/Init", {}, 22)})}).find("a stage can only be part of a simulation command") !=
          std::string::npos);
}

TEST_CASE("a component has one simulation command")
{
    const CommandNode one = composite("1", "One/Simulation", {stage("Step", {})}, 4),
                      two = composite("2", "Two/Simulation", {stage("Step", {})}, 5);
    CHECK(errors_of({with_commands(group("o", {}), {one, two})}) ==
          "scene.xml:5:1: command 2 (Two/Simulation): a component can have only one simulation command, which is already "
          "'One/Simulation'");
}

TEST_CASE("lists that refer to themselves, or would grow without bound")
{
    const CommandNode run = simulation_command({stage("Step", {see_command("x")})});
    CHECK(errors_of({with_commands(group("o", {}),
                                   {composite("x", "X", {see_command("y")}, 4), composite("y", "Y", {see_command("x")}, 5), run})}) ==
          "scene.xml:4:1: command x (X): circular reference of commands: 'x' -> 'y' -> 'x'");
    // Each list names the next one twice: 2^40 items.
    std::vector<CommandNode> commands;
    for (int i = 0; i < 40; ++i)
        commands.push_back(composite("c" + std::to_string(i), "",
                                     {see_command("c" + std::to_string(i + 1)), see_command("c" + std::to_string(i + 1))}, 4));
    commands.push_back(with_id("c40", command("s", "State/Restore", 5)));
    commands.push_back(simulation_command({stage("Rewind", {see_command("c0")})}));
    CHECK_FALSE(errors_of({with_commands(group("o", {component("s", "State/RigidBody", {{"mass", "1"}})}), commands)}).empty());
}

TEST_CASE("a fragment cannot select or set components that are already in the scene")
{
    const model::SceneSpec s = compiled(scene({component("f", "Shape/Sphere"), shaft("a")}));
    CHECK(errors_of(scene({with_commands(group("o", {}), {setting(command("f", "Shape/Draw", 4), {text("SetRadius", "1", 5)})})}), &s) ==
          "scene.xml:4:1: command Shape/Draw: subject 'f' is already in the running scene: set its parameters by a "
          "request");
    CHECK(errors_of(scene({with_commands(group("o", {}), {simulation_command({stage("PostStep", {command("f", "Shape/Draw", 22)})})})}),
                    &s) == "scene.xml:22:1: command Shape/Draw: subject 'f' is already in the running scene: it keeps its commands");
    CHECK(errors_of(scene({with_commands(group("o", {}), {command("f", "Shape/Draw", 4)})}), &s).empty());
}
