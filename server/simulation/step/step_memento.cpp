#include "simulation/step/step_memento.h"

namespace plab::simulation
{
namespace
{

constexpr unsigned kChanging = world::kind_bit(FieldKind::State) | world::kind_bit(FieldKind::Output);

}  // namespace

void StepMemento::save(const world::World& world, const Stepper& stepper)
{
    if (const auto* some = stepper.contacts().rest().changing_since(contacts_.rest().mark))
        motion_.save_some(world.host(), *some);
    else
        motion_.save(world.host());
    cells_.clear();
    world.save_fields(kChanging, cells_);
    contacts_.copy(stepper.contacts());
    work_ = stepper.work(), contact_energy_ = stepper.contact_energy();
    departed_work_ = stepper.departed_work(), requests_work_ = stepper.requests_work();
    reported_ = stepper.reported();
    split_ = stepper.split();
    frame_ = stepper.frame();
}

void StepMemento::restore(world::World& world, Stepper& stepper) const
{
    ByteReader cells(cells_.bytes());
    world.load_fields(kChanging, cells);
    motion_.restore(world.host());
    stepper.forget_state();
    (void)stepper.rebuild();  // cannot fail: the same structure was built at the start of the step
    motion_.restore(world.host());
    stepper.contacts() = contacts_;
    stepper.work() = work_, stepper.contact_energy() = contact_energy_;
    stepper.departed_work() = departed_work_, stepper.requests_work() = requests_work_;
    stepper.reported() = reported_;
    stepper.continue_split(split_);
    stepper.continue_after(frame_.tick, frame_.start_time, frame_.step);
}

}  // namespace plab::simulation
