// The fields of Governor/Error.
#include "by_error.h"

namespace plab::governors
{

void ErrorRows::describe(Schema& schema)
{
    watch.describe(schema);
    schema.param(bound, "bound", unit::one, "error that is allowed within `interval`, against the next finer level, in the unit `unit`")
        .positive();
    schema
        .param(unit, "unit", unit::one,
               "`m`: a point of a body; `rad`: a body or a shaft; `W`: energy made or lost in a second; `pixels`: as viewers see it")
        .or_else("m")
        .one_of({"m", "rad", "W", "pixels"});
    schema.param(interval, "interval", unit::second, "time within which the error is counted").or_else(0.25).positive();
    schema.param(target, "target", unit::one, "share of the measurements that shall find the error still below the bound")
        .or_else(0.95)
        .at_least(0.5)
        .at_most(0.999);
    schema.param(looks, "looks", unit::one, "components that are measured at most in one look").or_else(8).positive();
    schema
        .param(share, "share", unit::one,
               "trial steps at most for each step of the watched components: only a sample of them is measured, and all get the level with "
               "which a share `target` of the sample keeps the bound; 0: no limit; not used with `pixels`")
        .or_else(0)
        .not_negative();
    schema.param(look_ahead, "look_ahead", unit::second, "of `pixels`: what may come into view within this time counts as seen")
        .or_else(0.5)
        .not_negative();
    schema.param(margin, "margin", unit::radian, "of `pixels`: what is outside of the picture by less than this angle counts as seen")
        .or_else(0.15)
        .not_negative();
    schema.state(next, "next", unit::one, "when a component is measured again, s");
    schema.state(safety, "safety", unit::one, "factor by which measured errors are taken to be larger").initially(2);
    schema
        .state(patience, "patience", unit::one,
               "times `every` after which what is far below the bound is measured again; it falls with each promise that is broken")
        .initially(3);
    schema.state(judged, "judged", unit::one, "measurements of a level that was measured before");
    schema.state(held, "held", unit::one, "those of them that found the error still below the bound");
    schema.state(allowance, "allowance", unit::one, "trial steps that may be made within `share`");
    schema.state(sampled, "sampled", unit::one, "with `share`: components that were sampled, by level; older ones fade");
    schema.state(sampled_held, "sampled_held", unit::one, "those of them whose error was below the bound");
    schema.scratch(enough, "enough", "m or rad: the trial that it asks for may end where the error exceeds this; 0: it goes on");
    schema.output(confidence, "confidence", unit::one, "with which a level's error is below the bound when it is measured again");
    schema.output(worst, "worst", unit::one,
                  "the largest error of the last look in which something was measured, of the levels that were kept");
    schema.output(measured, "measured", unit::one, "number of errors that were measured");
    schema.output(unknown, "unknown", unit::one, "number of those that could not be told");
}

}  // namespace plab::governors
