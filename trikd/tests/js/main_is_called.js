var __interpretation_started_timestamp__;
var a;
var main = function()
{
	__interpretation_started_timestamp__ = Date.now();
	a = 3;
	print("in main ", a);
	return;
}
//> in main 3
