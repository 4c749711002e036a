// tower.cpp -- the C interface from C++98: objects that clean up after themselves, a failure as an exception, depth beside the picture.
#include <gnomon/gnomon.h>
#include <cstdio>
#include <stdexcept>
#include <vector>

namespace {

class Scene {
public:
    Scene() : context_(0), scene_(0)
    {
        gno_status status = gno_context_create(0, &context_);
        if (status == GNO_OK) status = gno_scene_create(context_, &scene_);
        if (status != GNO_OK) {
            gno_context_destroy(context_);
            throw std::runtime_error(gno_status_text(status));
        }
    }
    ~Scene()
    {
        gno_scene_destroy(scene_);
        gno_context_destroy(context_);
    }
    gno_scene *get() { return scene_; }
    void check(gno_status status) const
    {
        if (status != GNO_OK) throw std::runtime_error(gno_context_message(context_));
    }

private:
    Scene(const Scene &); // not to be copied
    Scene &operator=(const Scene &);
    gno_context *context_;
    gno_scene *scene_;
};

void addTriangle(Scene &scene, double x, double y, double z, double size)
{
    const double p[9] = {x - size, y, z, x + size, y, z, x, y, z + size};
    const int corner[3] = {0, 1, 2};
    gno_mesh_def mesh = gno_mesh_def_default();
    mesh.vertex_count = mesh.corner_count = 3;
    mesh.positions = p;
    mesh.polygon_count = mesh.ring_count = 1;
    mesh.corner_vertex = corner;
    scene.check(gno_scene_add_mesh(scene.get(), &mesh, 0));
}

} // namespace

int main()
{
    try {
        Scene scene;
        gno_image_def image = gno_image_def_default();
        image.width = 64;
        image.height = 48;
        scene.check(gno_scene_set_image(scene.get(), &image));
        for (int i = 0; i < 4; i++) addTriangle(scene, 0, 0.5 * i, 0.4 * i, 1);
        std::vector<float> rgb(3 * 64 * 48), depth(64 * 48);
        gno_layers layers = gno_layers_default();
        gno_render_def def = gno_render_def_default();
        layers.depth = &depth[0];
        def.layers = &layers;
        scene.check(gno_render(scene.get(), &def, &rgb[0], 0));
        std::printf("depth in the middle: %.3f\n", depth[24 * 64 + 32]);
    } catch (const std::exception &failure) {
        std::fprintf(stderr, "tower: %s\n", failure.what());
        return 1;
    }
    return 0;
}
