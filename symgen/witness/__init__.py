"""An independent derivation: every quantity of a model by CasADi's automatic differentiation."""
