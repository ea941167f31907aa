#include "import/mjcf_actuator.h"

#include <array>
#include <cmath>

namespace plab::import
{
namespace
{

/// A range that counts: `limited`="true", or "auto" with a range where the compiler says so.
void read_range(const XmlElement& e, const std::string& what, const MjcfSettings& settings, double& lower, double& upper,
                Document& document)
{
    double range[2];
    const bool given = document.numbers(e, what + "range", range, 2) == 2;
    const std::string limited = document.text(e, what + "limited");
    if (limited == "false" || (limited != "true" && !(given && settings.auto_limits()))) return;
    if (!given) return document.error(e, what + "limited needs a " + what + "range");
    if (!(range[0] < range[1])) return document.error(e, what + "range must be two ascending numbers");
    lower = range[0], upper = range[1];
}

bool is_one_of(const std::string& text, std::initializer_list<std::string_view> allowed)
{
    return std::find(allowed.begin(), allowed.end(), text) != allowed.end();
}

/// gain and bias of <general>. False if it is listed.
bool read_general(const XmlElement& e, Actuator& out, Document& document)
{
    const auto lost = [&](const std::string& why) { return document.lost(e, "is not carried over: " + why), false; };
    if (!is_one_of(document.text(e, "dyntype"), {"", "none"})) return lost("it has a state of its own");
    if (!is_one_of(document.text(e, "gaintype"), {"", "fixed"})) return lost("only gaintype=\"fixed\" is");
    const std::string bias_type = document.text(e, "biastype");
    if (!is_one_of(bias_type, {"", "none", "affine"})) return lost("only biastype=\"none\" or \"affine\" is");
    std::array<double, 10> gain{1}, bias{};
    document.numbers(e, "gainprm", gain, 1), document.numbers(e, "biasprm", bias, 1);
    out.gain = gain[0];
    if (bias_type == "affine") out.bias = {bias[0], bias[1], bias[2]};
    return true;
}

/// The law of a <position>, a <velocity> or a <motor>. False if it is listed.
bool read_law(const XmlElement& e, Actuator& out, Document& document)
{
    if (e.name == "general") return read_general(e, out, document);
    const double kp = document.number(e, "kp", 1), kv = document.number(e, "kv", e.name == "velocity" ? 1 : 0);
    if (kp < 0 || kv < 0) return document.error(e, "kp and kv must not be negative"), false;
    const bool delayed = document.number(e, "timeconst", 0) != 0 || document.number(e, "dampratio", 0) != 0;
    if (delayed) return document.lost(e, "is not carried over: timeconst and dampratio are not"), false;
    if (e.name == "position") out.gain = kp, out.bias = {0, -kp, -kv};
    if (e.name == "velocity") out.gain = kv, out.bias = {0, 0, -kv};
    return true;
}

}  // namespace

void read_actuators(const XmlElement& section, MjcfSettings& settings, std::vector<Actuator>& out, Document& document)
{
    for (const XmlElement& own : section.children)
    {
        if (!is_actuator(own.name))
        {
            document.lost(own, "is not carried over");
            continue;
        }
        list_unused_attributes(own, document);
        const XmlElement e = settings.resolved(own, "");
        Actuator actuator;
        actuator.where = e.where, actuator.joint = document.text(e, "joint"), actuator.name = document.text(e, "name");
        actuator.tendon = document.text(e, "tendon");
        if (actuator.joint.empty() == actuator.tendon.empty())
        {
            document.lost(e, "is not carried over: only actuators of a joint or of a tendon are");
            continue;
        }
        if (actuator.name.empty()) actuator.name = actuator.joint + actuator.tendon + "." + e.name;
        double gear[6] = {1, 0, 0, 0, 0, 0};
        document.numbers(e, "gear", gear, 1);
        actuator.gear = gear[0];
        if (gear[0] == 0) document.error(e, "gear must not begin with zero");
        read_range(e, "ctrl", settings, actuator.control_lower, actuator.control_upper, document);
        read_range(e, "force", settings, actuator.force_lower, actuator.force_upper, document);
        if (read_law(e, actuator, document)) out.push_back(std::move(actuator));
    }
}

}  // namespace plab::import
