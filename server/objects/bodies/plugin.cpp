#include "plab/plugin.h"

#include "material_pair.h"
#include "states.h"
#include "user.h"

namespace
{

template <auto Prepare, class Table>
plab::TypeBuilder<Table> add_state(plab::Registrar& registrar, std::string name, plab::Facet facet, std::string family, std::string doc)
{
    auto type = registrar.component<Table>(std::move(name), std::move(doc));
    type.facet(facet)
        .family(std::move(family))
        .template command<Prepare>(plab::Phase::Prepare, "State/Prepare", "checks the parameters and hands them to the host")
        .host_command(plab::Phase::Restore, "State/Restore", "brings the saved state back when a step is rewound");
    return type;
}

}  // namespace

PLAB_PLUGIN("bodies", registrar)
{
    using namespace plab::bodies;
    using plab::Facet;
    add_state<prepare_static, StaticRows>(registrar, "State/Static", Facet::Body, "State/Body", "a body that never moves");
    add_state<prepare_kinematic, KinematicRows>(registrar, "State/Kinematic", Facet::Body, "State/Body",
                                                "a body that moves with a prescribed velocity");
    add_state<prepare_rigid_body, RigidBodyRows>(registrar, "State/RigidBody", Facet::Body, "State/Body", "a body that moves by forces");
    add_state<prepare_shaft, ShaftRows>(registrar, "State/Shaft", Facet::Shaft, "State/Shaft",
                                        "one degree of freedom about an axle: a gear, a motor, a fan");
    add_state<prepare_quantities, QuantitiesRows>(registrar, "State/Quantities", Facet::Quantities, "State/Quantities",
                                                  "numbers that change at the rates that interactions add");
    registrar.component<MaterialPairRows>("Material/Pair", "friction and restitution between two materials")
        .family("Material/Pair")
        .command<connect_material_pair>(plab::Phase::Connect, "Material/Connect", "registers the law of the pair with the host");
    add_state<prepare_user, UserRows>(registrar, "State/User", Facet::Body, "State/Body",
                                      "a person's hand or device: follows samples from outside, and knows the force on it")
        .command<follow_samples>(plab::Phase::Drive, "User/Follow", "chooses the velocity that leads to the newest sample, extrapolated")
        .command<feel>(plab::Phase::Finish, "User/Feel", "sums what contacts and held bodies exert")
        .strengths("interaction by people and robots outside: it pushes, and Constraint/Grab makes it hold")
        .limits("nothing pushes it back: a device must render `force`; faster than its limits it lags behind");
}
