"""The paper's numbers against the step of a Runge-Kutta method."""
