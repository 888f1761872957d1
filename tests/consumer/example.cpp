// Renders a glTF scene into an OpenEXR file and prints the mean of its red channel: example SCENE OUT.exr SIZE
#include <cstdio>
#include <cstdlib>
#include <numeric>

#include <isophote/gltf.hpp>
#include <isophote/path_tracer.hpp>

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const isophote::Scene scene = isophote::loadGltf(argv[1]);
  const isophote::Camera camera = scene.cameras.empty() ? isophote::framingCamera(scene, 1.0) : scene.cameras.front();
  const uint32_t size = static_cast<uint32_t>(std::atoi(argv[3]));

  const isophote::VulkanInstance instance;
  const isophote::Device device(instance);
  const isophote::GpuScene gpuScene(device, scene);
  isophote::Film film(device, {.width = size, .height = size});
  isophote::PathTracer tracer(device, gpuScene);
  tracer.render(camera, film, {.first = 0, .last = 64});

  const isophote::Image image = film.resolve();
  isophote::writeExr(argv[2], image);
  const std::vector<float>& red = image.find("R")->values;
  std::printf("mean red %.6f\n", std::accumulate(red.begin(), red.end(), 0.0) / static_cast<double>(red.size()));
}
