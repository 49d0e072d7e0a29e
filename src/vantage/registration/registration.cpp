namespace vantage {}
