#include "plab/plugin.h"

#include "osmesa_camera.h"

PLAB_PLUGIN("cameras", registrar)
{
    using namespace plab::cameras;
    registrar.component<CameraRows>("Camera/OSMesa", "pictures of the running scene, drawn off-screen in the server")
        .family("Camera")
        .command<draw>(plab::Phase::Draw, "Camera/Draw", "draws if a picture is due and a client wants it")
        .cost("nothing while no client wants pictures; else about 15 to 40 ms of the step thread for a picture of 800 x 600");
}
