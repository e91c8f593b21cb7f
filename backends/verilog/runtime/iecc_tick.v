// Divides a clock by a whole number, exactly.
//
// `wrap` is high in every PERIOD-th clock in which `enable` is high. Registered by the user, it marks
// the first clock at or after a boundary of the unit that is counted; the first one comes PERIOD
// enabled clocks after reset. Dividers are chained by `enable`, so their ticks coincide.
module iecc_tick #(
    parameter WIDTH = 16,
    parameter [WIDTH-1:0] LAST = 16'd49999  // PERIOD - 1
) (
    input  wire clk,
    input  wire rst,
    input  wire enable,
    output wire wrap
);

    reg [WIDTH-1:0] count;

    wire last = count == LAST;
    assign wrap = enable & last;

    always @(posedge clk)
        if (rst)
            count <= {WIDTH{1'b0}};
        else if (enable)
            count <= last ? {WIDTH{1'b0}} : count + {{(WIDTH-1){1'b0}}, 1'b1};

endmodule
