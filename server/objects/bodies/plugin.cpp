#include "plab/plugin.h"

#include "material_pair.h"
#include "states.h"

namespace
{

template <auto Prepare, class Table>
void add_state(plab::Registrar& registrar, std::string name, plab::Facet facet, std::string family, std::string doc)
{
    registrar.component<Table>(std::move(name), std::move(doc))
        .facet(facet)
        .family(std::move(family))
        .template command<Prepare>(plab::Phase::Prepare, "State/Prepare", "checks the parameters and hands them to the host")
        .host_command(plab::Phase::Restore, "State/Restore", "brings the saved state back when a step is rewound");
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
}
