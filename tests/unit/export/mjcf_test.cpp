// Scenes as MJCF: imported again, they are the same bodies and joints and take the same course.
#include "export/mjcf.h"

#include "unit/import/imported.h"

namespace plab::test
{
namespace
{

using import::SceneFormat;

exported::ExportedScene export_of(Scene& scene) { return exported::write_mjcf(scene.simulation().world(), scene.simulation().dt()); }

bool lists(const exported::ExportedScene& scene, const std::string& text)
{
    return std::ranges::any_of(scene.losses, [&](const Error& loss) { return loss.text().find(text) != std::string::npos; });
}

void check_same_body(const Scene& a, const Scene& b, const std::string& id)
{
    CAPTURE(id);
    CHECK(b.real(id, "mass") == doctest::Approx(a.real(id, "mass")).epsilon(1e-14));
    CHECK(distance(b.vec(id, "center_of_mass"), a.vec(id, "center_of_mass")) < 1e-14);
    CHECK(distance(b.vec(id, "position"), a.vec(id, "position")) < 1e-13);
    CHECK(attitude_error(b.quat(id, "orientation"), a.quat(id, "orientation")) < 1e-7);
    const Mat3 I = std::get<Mat3>(a.get(id, "inertia")), J = std::get<Mat3>(b.get(id, "inertia"));
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) CHECK(std::fabs(J(i, j) - I(i, j)) <= 1e-13 * std::fabs(I(0, 0)));
}

TEST_CASE("the walker of MJCF, exported and imported again: the same masses, joints, stops, rotors and motors, and the same course")
{
    Scene first = imported_scene(imported_file("walker.mjcf"));
    const auto text = export_of(first);
    CHECK(text.bodies == 5);
    CHECK(text.joints == 4);
    Scene second = imported_scene(imported_text(text.text, SceneFormat::Mjcf));
    CHECK(second.simulation().dt() == 0.002);
    for (const char* const body : {"torso", "left_thigh", "left_shin", "right_thigh", "right_shin"}) check_same_body(first, second, body);
    for (const std::string joint : {"left_hip", "left_knee", "right_hip", "right_knee"})
    {
        CAPTURE(joint);
        CHECK(distance(second.vec(joint, "axis"), first.vec(joint, "axis")) < 1e-14);
        CHECK(distance(second.vec(joint, "anchor"), first.vec(joint, "anchor")) < 1e-14);
        for (const char* const bound : {"lower", "upper"})
            CHECK(second.real(joint + ".limit", bound) == doctest::Approx(first.real(joint + ".limit", bound)).epsilon(1e-14));
        CHECK(second.real(joint + ".spring", "damping") == first.real(joint + ".spring", "damping"));
        CHECK(second.real(joint + ".rotor", "inertia") == doctest::Approx(first.real(joint + ".rotor", "inertia")).epsilon(1e-14));
    }
    CHECK(second.real("left_hip_motor", "gear") == 40);
    first.warnings_expected = second.warnings_expected = true;
    // To rounding: also while both feet stand, where rows disagree by rounding and points barely press.
    first.run(0.55), second.run(0.55);
    for (const char* const body : {"torso", "left_shin", "right_shin"})
        CHECK(distance(second.vec(body, "position"), first.vec(body, "position")) < 1e-12);
}

TEST_CASE("an exported scene that has moved begins where it is: zeros of joints, stops and springs stay where they are")
{
    const std::string arm = R"(<mujoco><worldbody><body name="a" pos="0 0 2"><inertial pos="0.5 0 0" mass="2" diaginertia="0.1 0.1 0.1"/>
      <joint name="j" axis="0 1 0" range="-60 60" stiffness="3" springref="20"/><body name="b" pos="1 0 0"><inertial pos="0 0 0.1" mass="1"
      diaginertia="0.1 0.1 0.1"/><joint name="s" type="slide" axis="1 0 0" range="-0.5 0.5" damping="2"/></body></body></worldbody></mujoco>)";
    Scene first = imported_scene(imported_text(arm, SceneFormat::Mjcf));
    first.run(0.1);
    const auto text = export_of(first);
    CHECK(lists(text, "a (State/RigidBody): begins at rest in MJCF"));
    const auto again = imported_text(text.text, SceneFormat::Mjcf);
    Scene second = imported_scene(again);
    for (const char* const body : {"a", "b"}) check_same_body(first, second, body);
    const double turned = first.real("j", "angle");
    CHECK(std::fabs(turned) > 0.01);
    CHECK(second.real("j.limit", "lower") == doctest::Approx(-std::numbers::pi / 3 - turned).epsilon(1e-9));
    CHECK(second.real("j.spring", "rest") == doctest::Approx(std::numbers::pi / 9 - turned).epsilon(1e-9));
    CHECK(second.real("s.spring", "damping") == 2);
    CHECK(second.real("s.limit", "upper") == doctest::Approx(0.5 - first.real("s", "travelled")).epsilon(1e-9));
}

TEST_CASE("joints whose b is nearer to the world, loops, welds, gears, and what collides with what")
{
    const auto body = [](const std::string& id, const std::string& x, const std::string& more = "")
    {
        return "<component id='" + id + "' type='State/RigidBody' position='" + x +
               " 0 1' mass='1' center_of_mass='0 0 0' inertia='0.1 0.1 0.1'>" + more + "</component>";
    };
    Scene scene(
        body("p", "0", "<component id='ball' type='Shape/Sphere' radius='0.1'/>") + body("q", "1") + body("r", "2") + body("w", "3") +
        body("free", "9", "<component id='box' type='Shape/Box' half_extents='0.1 0.1 0.1'/>") +
        "<component id='base' type='Constraint/Hinge' b='q' anchor='1 0 1' axis='0 1 0'/>"
        "<component id='back' type='Constraint/Hinge' a='p' b='q' anchor='0.5 0 1' axis='0 1 0'/>"
        "<component id='back.limit' type='Constraint/Limit' a='p' b='q' anchor='0.5 0 1' axis='0 1 0' lower='-0.1' upper='0.4' "
        "manager='m'/>"
        "<component id='base2' type='Constraint/Hinge' b='r' anchor='2 0 1' axis='0 1 0'/>"
        "<component id='rod' type='Constraint/Ball' a='p' b='r' anchor='1.5 0 1'/>"
        "<component id='weld' type='Constraint/Fixed' a='r' b='w' anchor='2.5 0 1'/>"
        "<component id='gear' type='Constraint/Gear' driver='q' driven='r' velocity_factor='-2' driver_axis='0 1 0' driven_axis='0 1 0'/>"
        "<component id='spring' type='Constraint/SpringDamper' a='p' b='r' stiffness='5'/>"
        "<component id='m' type='Manager/Direct'/><component id='g' type='Field/Gravity' between='p q r w'/>"
        "<component id='contact' type='CDetection/ODE' between='free' against='p' response='answer'/>"
        "<component id='answer' type='Response/Automatic' friction='0.3' manager='m'/>");
    REQUIRE_MESSAGE(scene.loaded(), scene.error());
    const auto out = export_of(scene);
    CHECK(lists(out, "spring (Constraint/SpringDamper): has no counterpart in MJCF"));
    CHECK(out.text.find("<connect name=\"rod\" body1=\"r\" body2=\"p\" anchor=\"-0.5 0 0\"/>") != std::string::npos);
    CHECK(out.text.find("<joint name=\"gear\" joint1=\"base2\" joint2=\"base\" polycoef=\"0 -2 0 0 0\"/>") != std::string::npos);
    CHECK(out.text.find("gravcomp=\"1\"") != std::string::npos);
    const auto again = imported_text(out.text, SceneFormat::Mjcf);
    Scene second = imported_scene(again);
    for (const char* const id : {"p", "q", "free"}) check_same_body(scene, second, id);
    // p hangs on q now, so that the joint turns the other way.
    CHECK(distance(second.vec("back", "axis"), {0, -1, 0}) < 1e-14);
    CHECK(second.real("back.limit", "lower") == doctest::Approx(-0.1));
    CHECK(second.real("back.limit", "upper") == doctest::Approx(0.4));
    CHECK(second.real("r", "mass") == doctest::Approx(2));  // with what is welded to it
    CHECK(second.real("gear", "velocity_factor") == -2);
    CHECK(second.real("contact.response", "friction") == 0.3);
    CHECK(again.blueprint.find("Constraint/Ball") != std::string::npos);
}

TEST_CASE("meshes are exported with their vertices, and a servo as a general actuator")
{
    const std::string model = R"(<mujoco><asset><mesh name="t" vertex="0 0 0 1 0 0 0 1 0 0 0 1" face="0 2 1 0 1 3 0 3 2 1 2 3"/></asset>
      <worldbody><body name="a"><joint name="j" ref="30" axis="0 1 0"/><geom type="mesh" mesh="t"/></body></worldbody>
      <actuator><position name="servo" joint="j" kp="7" kv="0.5" gear="2" ctrlrange="-1 1"/></actuator></mujoco>)";
    Scene first = imported_scene(imported_text(model, SceneFormat::Mjcf));
    CHECK(first.real("a", "mass") == doctest::Approx(1000.0 / 6));
    const auto text = export_of(first);
    Scene second = imported_scene(imported_text(text.text, SceneFormat::Mjcf));
    check_same_body(first, second, "a");
    CHECK(second.real("servo", "gain") == 7);
    CHECK(second.real("servo", "gear") == 2);
    CHECK(second.real("servo", "control_upper") == 1);
    CHECK(distance(second.vec("servo", "bias"), first.vec("servo", "bias")) < 1e-12);
}

}  // namespace
}  // namespace plab::test
