// Falling edges of the two clocks, made without evaluating the model where that can be.
//
// Nothing in the design looks at a falling edge. So where the name is known under which Verilator keeps a
// clock's last level (5.006's, 5.020's), that is set instead of evaluating all for nothing: half the work.
// Returns whether it was.
template <typename Root>
auto bus_clock_falls(Root* root, int) -> decltype(root->__Vtrigrprev__TOP__clk_i, bool()) {
  root->__Vtrigrprev__TOP__clk_i = 0;
  return true;
}
template <typename Root>
auto bus_clock_falls(Root* root, int) -> decltype(root->__Vtrigprevexpr___TOP__clk_i__0, bool()) {
  root->__Vtrigprevexpr___TOP__clk_i__0 = 0;
  return true;
}
template <typename Root>
bool bus_clock_falls(Root*, long) {
  return false;
}
template <typename Root>
auto vga_clock_falls(Root* root, int) -> decltype(root->__Vtrigrprev__TOP__vga_clk_i, bool()) {
  root->__Vtrigrprev__TOP__vga_clk_i = 0;
  return true;
}
template <typename Root>
auto vga_clock_falls(Root* root, int) -> decltype(root->__Vtrigprevexpr___TOP__vga_clk_i__0, bool()) {
  root->__Vtrigprevexpr___TOP__vga_clk_i__0 = 0;
  return true;
}
template <typename Root>
bool vga_clock_falls(Root*, long) {
  return false;
}
