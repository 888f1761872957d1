#include "viewer/panel.hpp"

#include <algorithm>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#include <fmt/format.h>
#include <imgui.h>

#include "viewer/options.hpp"
#include "viewer/vulkan_objects.hpp"

namespace isophote::viewer {
namespace {

UniqueHandle<VkDescriptorPool> makeDescriptorPool(const Device& device) {
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1}; // the font
  const VkDescriptorPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                        .flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT,
                                        .maxSets = 1,
                                        .poolSizeCount = 1,
                                        .pPoolSizes = &size};
  VkDescriptorPool pool = VK_NULL_HANDLE;
  check(vkCreateDescriptorPool(device.handle(), &info, nullptr, &pool), "vkCreateDescriptorPool");
  return {device.handle(), pool, vkDestroyDescriptorPool};
}

void text(const std::string& line) { ImGui::TextUnformatted(line.c_str()); }

std::string errorText(const ErrorEstimate& error) {
  if (!error.known) return "error: not known yet";
  return fmt::format("error: {:.2f}% ({:.2f}% to {:.2f}%)", 100 * error.value, 100 * error.lower, 100 * error.upper);
}

} // namespace

Panel::Panel(const Device& device, const Window& window, VkRenderPass renderPass, uint32_t imageCount)
    : descriptors_(makeDescriptorPool(device)) {
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr; // leaves no file in the current folder
  ImGui::StyleColorsDark();
  ImGui_ImplGlfw_InitForVulkan(window.handle(), true);
  ImGui_ImplVulkan_InitInfo info{};
  info.Instance = device.instance();
  info.PhysicalDevice = device.physical();
  info.Device = device.handle();
  info.QueueFamily = device.queueFamily();
  info.Queue = device.queue();
  info.DescriptorPool = descriptors_.get();
  info.MinImageCount = std::max(imageCount, 2u);
  info.ImageCount = info.MinImageCount;
  info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
  info.CheckVkResultFn = [](VkResult result) { check(result, "Dear ImGui"); };
  ImGui_ImplVulkan_Init(&info, renderPass);
  uploadFonts(device);
}

Panel::~Panel() {
  ImGui_ImplVulkan_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

void Panel::uploadFonts(const Device& device) {
  submitOnce(device, [](VkCommandBuffer commands) { ImGui_ImplVulkan_CreateFontsTexture(commands); });
  ImGui_ImplVulkan_DestroyFontUploadObjects();
}

PanelClicks Panel::layout(PanelState& state) {
  ImGui_ImplVulkan_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
  PanelClicks clicks;
  if (state.visible) {
    ImGui::SetNextWindowPos({12, 12}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowBgAlpha(0.75f);
    ImGui::Begin("Isophote", nullptr, ImGuiWindowFlags_AlwaysAutoResize);
    text(state.device);
    text(fmt::format("{} x {} pixels, {} samples each", state.width, state.height, state.samples));
    text(errorText(state.error));
    text(fmt::format("{:.2f} Mrays/s", 1e-6 * state.raysPerSecond));
    ImGui::SliderFloat("exposure", &state.exposure, -8, 8, "%+.1f EV");
    int toneMap = static_cast<int>(state.toneMap);
    ImGui::Combo("tone map", &toneMap, kToneMapNames, static_cast<int>(std::size(kToneMapNames)));
    state.toneMap = static_cast<ToneMap>(toneMap);
    clicks.saveExr = ImGui::Button("Save EXR");
    ImGui::SameLine();
    clicks.savePng = ImGui::Button("Save PNG");
    ImGui::SameLine();
    clicks.restart = ImGui::Button("Start over");
    text("S save  R start over  H hide  Esc quit");
    if (!state.message.empty()) text(state.message);
    ImGui::End();
  }
  ImGui::Render();
  return clicks;
}

void Panel::record(VkCommandBuffer commands) const { ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), commands); }

} // namespace isophote::viewer
